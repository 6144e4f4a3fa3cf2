// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/code_count.h"

#include <algorithm>
#include <numeric>

#include "hal/media/samples.h"

namespace relievo {
namespace {

constexpr std::uint32_t kTop = 0xffff;

bool isGray16(const Frame& frame) noexcept {
  return frame.model == ColorModel::Gray && frame.components[0].bits == 16;
}

std::uint32_t grayAt(const Frame& frame, int c, int r) noexcept {
  return codeAt(frame, frame.components[0], c, r);
}

}  // namespace

CodeCount::CodeCount(const Frame& depth) : bits_(std::max<int>(8, depth.components[0].bits)) {
  of_code_.assign(std::size_t{1} << bits_, 0);
  const Component& k = brightnessOf(depth);
  const Plane& plane = depth.planes[k.plane];
  for (int r = 0; r < depth.height; ++r) {
    const std::uint8_t* at = plane.data + r * plane.stride_bytes + k.offset_bytes;
    for (int c = 0; c < depth.width; ++c, at += k.step_bytes) ++of_code_[codeAt(k, at) & (of_code_.size() - 1)];
  }
  samples_ = static_cast<std::uint64_t>(depth.width) * static_cast<std::uint64_t>(depth.height);
}

double CodeCount::share(std::uint32_t low, std::uint32_t high) const {
  high = std::min<std::uint32_t>(high, static_cast<std::uint32_t>(of_code_.size()) - 1);
  if (low > high || samples_ == 0) return 0;
  const auto sum = std::accumulate(of_code_.begin() + low, of_code_.begin() + high + 1, std::uint64_t{0});
  return static_cast<double>(sum) / static_cast<double>(samples_);
}

double CodeCount::share(const CodeSet& set) const {
  return samples_ == 0 ? 0 : 1 - static_cast<double>(without(set).samples_) / static_cast<double>(samples_);
}

std::uint32_t CodeCount::quantile(double q, std::uint32_t low, std::uint32_t high) const {
  high = std::min<std::uint32_t>(high, static_cast<std::uint32_t>(of_code_.size()) - 1);
  double left = q * share(low, high) * static_cast<double>(samples_);
  for (std::uint32_t code = low; code <= high; ++code) {
    if (of_code_[code] == 0) continue;
    left -= static_cast<double>(of_code_[code]);
    if (left <= 0) return code;
  }
  return low;
}

CodeCount::Reach CodeCount::reach(double outliers, std::uint32_t low, std::uint32_t high) const {
  Reach reach{quantile(outliers, low, high), quantile(1 - outliers, low, high)};
  for (const CodeCount& later : later_) {
    if (later.bits_ != bits_ || later.share(low, high) == 0) continue;
    reach.low = std::min(reach.low, later.quantile(outliers, low, high));
    reach.high = std::max(reach.high, later.quantile(1 - outliers, low, high));
  }
  return reach;
}

CodeCount CodeCount::together() const {
  CodeCount all = *this;
  all.later_.clear();
  for (const CodeCount& later : later_) {
    if (later.bits_ != bits_) continue;
    all.samples_ += later.samples_;
    for (std::size_t code = 0; code < of_code_.size(); ++code) all.of_code_[code] += later.of_code_[code];
  }
  return all;
}

std::uint32_t CodeCount::step() const {
  std::uint32_t step = 0;
  for (std::uint32_t code = 0; code < of_code_.size(); ++code) {
    if (of_code_[code] > 0 && code != kTop) step = std::gcd(step, code);
  }
  return step;
}

double CodeCount::remainders(std::uint32_t divisor, std::uint32_t most) const {
  std::uint64_t fit = 0, all = 0;
  for (std::uint32_t code = 1; code < of_code_.size() && code < kTop; ++code) {
    all += of_code_[code];
    if (code % divisor <= most) fit += of_code_[code];
  }
  return all == 0 ? 0 : static_cast<double>(fit) / static_cast<double>(all);
}

int CodeCount::kinds() const {
  return kinds(0, kTop);
}

int CodeCount::kinds(std::uint32_t low, std::uint32_t high) const {
  high = std::min<std::uint32_t>(high, static_cast<std::uint32_t>(of_code_.size()) - 1);
  if (low > high) return 0;
  const auto occurs = [](std::uint64_t n) { return n > 0; };
  return static_cast<int>(std::count_if(of_code_.begin() + low, of_code_.begin() + high + 1, occurs));
}

bool CodeCount::hasGapAtZero(std::uint32_t gap) const {
  constexpr double kHoles = 0.002;
  return share(0, 0) > kHoles && share(1, gap) == 0;
}

CodeCount CodeCount::without(const CodeSet& set) const {
  CodeCount rest = *this;
  for (std::uint32_t code = 0; code < of_code_.size(); ++code) {
    if (!set.contains(code)) continue;
    rest.samples_ -= rest.of_code_[code];
    rest.of_code_[code] = 0;
  }
  for (CodeCount& later : rest.later_) later = later.without(set);
  return rest;
}

bool isScattered(const Frame& depth) {
  if (!isGray16(depth)) return false;
  std::uint64_t readings = 0, alone = 0;
  for (int r = 1; r + 1 < depth.height; ++r) {
    for (int c = 1; c + 1 < depth.width; ++c) {
      if (grayAt(depth, c, r) == 0) continue;
      const int beside = (grayAt(depth, c - 1, r) != 0 ? 1 : 0) + (grayAt(depth, c + 1, r) != 0 ? 1 : 0) +
                         (grayAt(depth, c, r - 1) != 0 ? 1 : 0) + (grayAt(depth, c, r + 1) != 0 ? 1 : 0);
      ++readings;
      if (beside <= 2) ++alone;
    }
  }
  return readings > 0 && 2 * alone > readings;
}

double roughnessOf(const Frame& gray) {
  constexpr int kFewest = 32;
  const CodeCount count(gray);
  if (count.kinds() < kFewest) return 1;
  const std::uint32_t top = (1u << count.bits()) - 1;
  std::vector<std::uint32_t> differences;
  for (int r = 0; r < gray.height; ++r) {
    for (int c = 1; c < gray.width; ++c) {
      const std::uint32_t left = grayAt(gray, c - 1, r), here = grayAt(gray, c, r);
      const bool are_readings = std::min(left, here) > 0 && std::max(left, here) < top;
      if (are_readings) differences.push_back(left > here ? left - here : here - left);
    }
  }
  const auto [low, high] = count.reach(0.02, 1, top - 1);
  if (differences.empty() || high == low) return 1;
  const auto median = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::ranges::nth_element(differences, median);
  return static_cast<double>(*median) / (high - low);
}

}  // namespace relievo
