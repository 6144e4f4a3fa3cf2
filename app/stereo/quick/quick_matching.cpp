// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/quick_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace relievo {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr std::size_t kVector = 8;  // costs
constexpr int kReach = 2;           // pixels: of the census
constexpr int kOutline = 20;        // where neighbours differ by so many levels, a large change of disparity costs half
constexpr float kAgree = 1;         // pixels
constexpr int kSpeckOf = 2000;      // a smaller part of the picture is a speck
constexpr std::int16_t kHigh = 8000;
constexpr std::array kAcross{0, 1, -1};  // columns: where paths from another row come from

std::uint32_t bitsIn(std::uint32_t word) noexcept {
  word -= word >> 1 & 0x55555555U;
  word = (word & 0x33333333U) + (word >> 2 & 0x33333333U);
  word = (word + (word >> 4)) & 0x0F0F0F0FU;
  return (word + (word >> 8) + (word >> 16)) & 0x3FU;
}

// Costs of a disparity's change from one pixel to the next.
struct ChangeCosts {
  std::int16_t by_one = 0, by_more = 0;
};

// One pixel's costs along a path: those of the pixel before it, `least` among them, and its own.
std::int16_t continuePath(const std::int16_t* before, std::int16_t least, const std::uint8_t* costs, ChangeCosts change,
                          std::int16_t* now, std::int16_t* sums, std::size_t levels) noexcept {
  const auto far = static_cast<std::int16_t>(least + change.by_more);
  std::int16_t lowest = kHigh;
  const std::int16_t* const nearer = before - 1;  // a high cost lies before the first cost and after the last
  const std::int16_t* const farther = before + 1;
  for (std::size_t d = 0; d < levels; ++d) {
    const auto beside = static_cast<std::int16_t>(std::min(nearer[d], farther[d]) + change.by_one);
    const std::int16_t best = std::min(std::min(before[d], beside), far);
    const auto cost = static_cast<std::int16_t>(costs[d] + best - least);
    now[d] = cost;
    sums[d] = static_cast<std::int16_t>(sums[d] + cost);
    lowest = std::min(lowest, cost);
  }
  return lowest;
}

}  // namespace

const DisparityMap& QuickMatching::match(const ViewPicture& left, const ViewPicture& right, DisparityRange range) {
  prepare(left, range);
  lumaOf(left, left_luma_);
  lumaOf(right, right_luma_);
  takeCensus(left_luma_, left_census_);
  takeCensus(right_luma_, right_census_);
  takeSteps(left);
  downward();
  upward();
  removeSpecks();
  return map_;
}

void QuickMatching::prepare(const ViewPicture& left, DisparityRange range) {
  if (map_.cols != left.cols || map_.rows != left.rows) map_ = DisparityMap(left.cols, left.rows);
  range_ = range;
  levels_ = (wanted() + kVector - 1) / kVector * kVector;
  costs_.resize(map_.size() * levels_);
  sums_.assign(map_.size() * levels_, 0);
  before_.assign(pathsFromRow() * static_cast<std::size_t>(map_.cols) * stride(), kHigh);
  now_.assign(2 * stride(), kHigh);
  none_.assign(stride(), kHigh);
  std::fill_n(&none_[kVector], levels_, Cost{0});
  none_.back() = 0;
  reversed_.resize(static_cast<std::size_t>(map_.cols) + 2 * levels_ +
                   2 * static_cast<std::size_t>(std::max({std::abs(range.lowest), std::abs(range.highest), 1})));
}

std::size_t QuickMatching::stride() const noexcept {
  return levels_ + 2 * kVector;
}

void QuickMatching::takeCensus(const std::vector<std::uint8_t>& luma, Census& census) const {
  census.assign(map_.size(), 0);
  for (int r = 0; r < map_.rows; ++r) {
    std::uint32_t* const out = &census[map_.at(0, r)];
    const std::uint8_t* const middle = &luma[map_.at(0, r)];
    for (int j = -kReach; j <= kReach; ++j) {
      const std::uint8_t* const row = &luma[map_.at(0, std::clamp(r + j, 0, map_.rows - 1))];
      for (int i = -kReach; i <= kReach; ++i) {
        if (i == 0 && j == 0) continue;
        const auto look = [&](int c, int x) { out[c] = out[c] << 1 | (row[x] > middle[c] + 2 ? 1U : 0U); };
        const int first = std::min(kReach, map_.cols), last = std::max(first, map_.cols - kReach);
        for (int c = 0; c < first; ++c) look(c, std::clamp(c + i, 0, map_.cols - 1));
        for (int c = first; c < last; ++c) look(c, c + i);
        for (int c = last; c < map_.cols; ++c) look(c, std::clamp(c + i, 0, map_.cols - 1));
      }
    }
  }
}

void QuickMatching::takeSteps(const ViewPicture& left) {
  const auto last = map_.cols - 1;
  const auto take = [&](std::vector<Cost>& costs, int across, int down) {
    costs.resize(map_.size());
    for (int r = 0; r < map_.rows; ++r) {
      for (int c = 0; c <= last; ++c)
        costs[map_.at(c, r)] =
            stepCost(left.pixel(c, r), left.pixel(std::clamp(c + across, 0, last), std::max(r + down, 0)));
    }
  };
  take(beside_, -1, 0);
  take(above_[1], 0, -1);
  if (!rule_.diagonals) return;
  take(above_[0], -1, -1);
  take(above_[2], 1, -1);
}

QuickMatching::Cost QuickMatching::stepCost(const std::uint8_t* a, const std::uint8_t* b) const noexcept {
  const int levels = rule_.by_color ? unlikeness(a, b) : std::abs(a[0] - b[0]);
  return static_cast<Cost>(std::max(rule_.least_step, rule_.step * kOutline / (kOutline + levels)));
}

// Reversed, the right view's words lie in the order of rising disparity. Beyond its sides its border is repeated.
void QuickMatching::costsOfRow(int r) {
  const std::uint32_t* const right = &right_census_[map_.at(0, r)];
  const int cols = map_.cols, low = range_.lowest;
  const auto count = static_cast<int>(reversed_.size());
  const int margin = (count - cols) / 2;
  for (int k = 0; k < count; ++k)
    reversed_[static_cast<std::size_t>(k)] = right[std::clamp(cols - 1 - (k - margin), 0, cols - 1)];
  for (int c = 0; c < cols; ++c) {
    const std::uint32_t own = left_census_[map_.at(c, r)];
    const std::uint32_t* const from = reversed_.data() + margin + cols - 1 - c + low;
    std::uint8_t* const out = &costs_[cell(c, r)];
    for (std::size_t d = 0; d < levels_; ++d) out[d] = static_cast<std::uint8_t>(bitsIn(own ^ from[d]));
  }
}

void QuickMatching::downward() {
  for (int r = 0; r < map_.rows; ++r) {
    costsOfRow(r);
    alongRow(r, 1);
    alongRow(r, -1);
    fromRow(r - 1, r);
  }
}

void QuickMatching::upward() {
  for (int r = map_.rows - 1; r >= 0; --r) {
    fromRow(r + 1, r);
    chooseInRow(r);
    checkRow(r);
  }
}

void QuickMatching::alongRow(int r, int step) {
  std::int16_t *before = &now_[kVector], *now = &now_[levels_ + 3 * kVector];
  std::fill(before, before + levels_, std::int16_t{0});
  std::int16_t least = 0;
  const int begin = step > 0 ? 0 : map_.cols - 1, end = step > 0 ? map_.cols : -1;
  for (int c = begin; c != end; c += step) {
    const ChangeCosts change{rule_.slope, beside_[map_.at(c == begin ? c : std::max(c, c - step), r)]};
    least = continuePath(before, least, &costs_[cell(c, r)], change, now, &sums_[cell(c, r)], levels_);
    std::swap(before, now);
  }
}

// In the order of the sweep: down, then up.
void QuickMatching::fromRow(int other, int r) {
  const std::size_t row = static_cast<std::size_t>(map_.cols) * stride();
  for (std::size_t i = 0; i < pathsFromRow(); ++i) fromRow(other, r, kAcross[i], &before_[i * row]);
}

// In an order in which each path is read before it is written.
void QuickMatching::fromRow(int other, int r, int across, Cost* paths) {
  const bool inside = other >= 0 && other < map_.rows;
  Cost* const now = &now_[kVector];
  const int sideways = 1 + (other < r ? across : -across);
  const std::vector<Cost>& steps = above_[static_cast<std::size_t>(sideways)];
  for (int i = 0; i < map_.cols; ++i) {
    const int c = across < 0 ? map_.cols - 1 - i : i, x = c + across;
    const bool begins = !inside || x < 0 || x >= map_.cols;
    const auto pathOf = [&](int col) { return paths + static_cast<std::size_t>(col) * stride() + kVector; };
    const Cost* const from = begins ? &none_[kVector] : pathOf(x);
    const ChangeCosts change{rule_.slope, begins ? Cost{0} : steps[other < r ? map_.at(c, r) : map_.at(x, other)]};
    const std::size_t end = levels_ + kVector - 1;
    const Cost least = continuePath(from, from[end], &costs_[cell(c, r)], change, now, &sums_[cell(c, r)], levels_);
    std::copy(now, now + levels_, pathOf(c));
    pathOf(c)[end] = least;
  }
}

// The least sum, interpolated between two disparities if its neighbours allow it.
void QuickMatching::chooseInRow(int r) {
  least_right_.assign(static_cast<std::size_t>(map_.cols), std::numeric_limits<Cost>::max());
  std::fill_n(&map_.from_right[map_.at(0, r)], map_.cols, kNothing);
  for (int c = 0; c < map_.cols; ++c) {
    const Cost* const sums = &sums_[cell(c, r)];
    const auto best = static_cast<std::size_t>(std::min_element(sums, sums + wanted()) - sums);
    auto found = static_cast<float>(range_.lowest + static_cast<int>(best));
    if (best > 0 && best + 1 < wanted()) {
      const int before = sums[best - 1], here = sums[best], after = sums[best + 1], bend = before + after - 2 * here;
      if (bend > 0) found += 0.5F * static_cast<float>(before - after) / static_cast<float>(bend);
    }
    map_.pixels[map_.at(c, r)] = found;
    const int there = c - range_.lowest - static_cast<int>(best);
    if (there < 0 || there >= map_.cols || sums[best] >= least_right_[static_cast<std::size_t>(there)]) continue;
    least_right_[static_cast<std::size_t>(there)] = sums[best];
    map_.from_right[map_.at(there, r)] = found;
  }
}

void QuickMatching::checkRow(int r) {
  for (int c = 0; c < map_.cols; ++c) {
    const float found = map_.pixels[map_.at(c, r)];
    const int there = nearest(static_cast<float>(c) - found);
    const bool agrees =
        there >= 0 && there < map_.cols && std::abs(map_.from_right[map_.at(there, r)] - found) <= kAgree;
    map_.seen[map_.at(c, r)] = agrees ? 1 : 0;
  }
}

// Small regions whose disparity differs from that of their surroundings.
void QuickMatching::removeSpecks() {
  const std::size_t least = map_.size() / kSpeckOf;
  visited_.assign(map_.size(), 0);
  std::vector<std::size_t>& part = speck_;
  for (std::size_t start = 0; start < map_.size(); ++start) {
    if (visited_[start] != 0 || map_.seen[start] == 0) continue;
    part.assign(1, start);
    visited_[start] = 1;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::size_t here = part[i], c = here % static_cast<std::size_t>(map_.cols);
      const auto visit = [&](std::size_t there) {
        if (visited_[there] != 0 || map_.seen[there] == 0) return;
        if (std::abs(map_.pixels[there] - map_.pixels[here]) > kAgree) return;
        visited_[there] = 1;
        part.push_back(there);
      };
      if (c > 0) visit(here - 1);
      if (c + 1 < static_cast<std::size_t>(map_.cols)) visit(here + 1);
      if (here >= static_cast<std::size_t>(map_.cols)) visit(here - static_cast<std::size_t>(map_.cols));
      if (here + static_cast<std::size_t>(map_.cols) < map_.size()) visit(here + static_cast<std::size_t>(map_.cols));
    }
    if (part.size() >= least) continue;
    for (const std::size_t i : part) map_.seen[i] = 0;
  }
}

}  // namespace relievo
