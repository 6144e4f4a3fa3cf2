// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/sub_pixel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace relievo {
namespace {

constexpr int kRounds = 2;
constexpr int kReach = 4;          // pixels around, each of which votes on the surface's position
constexpr float kWild = 12;        // levels: a misfit that counts half
constexpr float kFlat = 2 * 81;    // squared slopes of a place without texture: 9 x 9 pixels
constexpr int kNear = 5;           // pixels on each side whose mean is taken
constexpr float kSurface = 1;      // pixels of disparity between two surfaces
constexpr float kTerrace = 2;      // likewise, before the first round: what was found is right to a pixel
constexpr float kFarthest = 0.5F;  // pixels in a round

void lumaOf(const ViewPicture& view, std::vector<float>& luma) {
  luma.resize(view.size());
  for (std::size_t i = 0; i < luma.size(); ++i) luma[i] = static_cast<float>(*view.pixel(i));
}

// Calls take(k) for k = -Reach .. Reach, each known when this is compiled: the loop around it is made of vectors.
template <int Reach, class Take>
void aroundEach(Take&& take) {
  [&]<int... k>(std::integer_sequence<int, k...>) {
    (take(std::ptrdiff_t{k - Reach}), ...);
  }(std::make_integer_sequence<int, 2 * Reach + 1>());
}

// The sum of the values up to kReach away on each side; there are so many more of them.
void sumAlong(const std::vector<float>& values, float* __restrict sums, std::size_t count) {
  const float* const from = values.data() + kReach;
  for (std::size_t i = 0; i < count; ++i) {
    float sum = 0;
    aroundEach<kReach>([&](std::ptrdiff_t k) { sum += *(from + i + k); });
    sums[i] = sum;
  }
}

// The mean of the values near each one that lie on its surface.
void meansOf(const float* from, std::ptrdiff_t stride, int count, float surface, float* __restrict to) {
  for (int c = 0; c < count; ++c) {
    const float here = from[c];
    float sum = 0, weights = 0;
    aroundEach<kNear>([&](std::ptrdiff_t k) {
      const float near = from[c + k * stride];
      const float left = surface - std::abs(near - here), weight = left + std::abs(left);  // none without a branch
      sum += weight * near;
      weights += weight;
    });
    to[c] = sum / weights;
  }
}

}  // namespace

void SubPixel::refine(DisparityMap& map, const ViewPicture& left, const ViewPicture& right) {
  lumaOf(left, left_);
  lumaOf(right, right_);
  slopes_.assign(map.size(), 0);
  misfits_.assign(map.size(), 0);
  smooth(map, true, kTerrace);
  smooth(map, false, kTerrace);
  for (int i = 0; i < kRounds; ++i) {
    for (int r = 0; r < map.rows; ++r) compare(map, r);
    step(map);
    smooth(map, true, kSurface);
    smooth(map, false, kSurface);
  }
}

// For each pixel, reads the right view at its disparity, and then its difference from the left view.
void SubPixel::compare(const DisparityMap& map, int r) {
  const float* const left = &left_[map.at(0, r)];
  const float* const right = &right_[map.at(0, r)];
  const float* const found = &map.pixels[map.at(0, r)];
  const std::uint8_t* const seen = &map.seen[map.at(0, r)];
  const auto cols = static_cast<std::size_t>(map.cols);
  if (cols < 4) return;
  const auto last = static_cast<float>(map.cols - 2);
  shown_.resize(cols);
  slopes_there_.resize(cols);
  told_.assign(cols, 0);
  for (std::size_t c = 1; c + 1 < cols; ++c) {
    const float x = static_cast<float>(c) - found[c];
    const bool told = seen[c] != 0 && x >= 1 && x < last;
    const float place = told ? x : 1;
    const int whole = static_cast<int>(place);
    const float rest = place - static_cast<float>(whole);
    const float* const there = right + whole;
    shown_[c] = there[0] + rest * (there[1] - there[0]);
    slopes_there_[c] = (1 - rest) * (there[1] - there[-1]) + rest * (there[2] - there[0]);
    told_[c] = told ? 1.0F : 0.0F;
  }
  float* const slopes = &slopes_[map.at(0, r)];
  float* const misfits = &misfits_[map.at(0, r)];
  const float *const shown = shown_.data(), *const slopes_there = slopes_there_.data(), *const told = told_.data();
  for (std::size_t c = 1; c + 1 < cols; ++c) {
    const float slope = 0.25F * (slopes_there[c] + left[c + 1] - left[c - 1]);  // of both views
    const float misfit = left[c] - shown[c];
    const float weight = told[c] * (kWild * kWild / (kWild * kWild + misfit * misfit));
    slopes[c] = weight * slope * slope;
    misfits[c] = weight * slope * misfit;
  }
}

// Sums over the square around each pixel, from sums over its columns.
void SubPixel::step(DisparityMap& map) {
  const auto cols = static_cast<std::size_t>(map.cols);
  column_slopes_.assign(cols + 2 * kReach, 0);
  column_misfits_.assign(cols + 2 * kReach, 0);
  slope_sums_.resize(cols);
  misfit_sums_.resize(cols);
  const auto add = [&](int r, float sign) {
    if (r < 0 || r >= map.rows) return;
    float *const slopes = &column_slopes_[kReach], *const misfits = &column_misfits_[kReach];
    const float *const slopes_here = &slopes_[map.at(0, r)], *const misfits_here = &misfits_[map.at(0, r)];
    for (std::size_t c = 0; c < cols; ++c) {
      slopes[c] += sign * slopes_here[c];
      misfits[c] += sign * misfits_here[c];
    }
  };
  for (int r = 0; r < kReach; ++r) add(r, 1);
  for (int r = 0; r < map.rows; ++r) {
    add(r + kReach, 1);
    add(r - kReach - 1, -1);
    sumAlong(column_slopes_, slope_sums_.data(), cols);
    sumAlong(column_misfits_, misfit_sums_.data(), cols);
    float* const pixels = &map.pixels[map.at(0, r)];
    const std::uint8_t* const seen = &map.seen[map.at(0, r)];
    const float *const slopes = slope_sums_.data(), *const misfits = misfit_sums_.data();
    for (std::size_t c = 0; c < cols; ++c) {
      const float change = std::clamp(misfits[c] / (slopes[c] + kFlat), -kFarthest, kFarthest);
      pixels[c] -= seen[c] != 0 ? change : 0;
    }
  }
}

// Along rows or down columns; outside the picture's border there are no neighbours.
void SubPixel::smooth(DisparityMap& map, bool across, float surface) {
  smoothed_.resize(map.size());
  const std::ptrdiff_t stride = across ? 1 : map.cols;
  const int margin_c = across ? kNear : 0, margin_r = across ? 0 : kNear;
  for (int r = 0; r < map.rows; ++r) {
    const float* const row = &map.pixels[map.at(0, r)];
    float* const to = &smoothed_[map.at(0, r)];
    const int first = r < margin_r || r >= map.rows - margin_r ? map.cols : std::min(margin_c, map.cols);
    const int last = std::max(first, map.cols - margin_c);
    std::copy(row, row + first, to);
    meansOf(row + first, stride, last - first, surface, to + first);
    std::copy(row + last, row + map.cols, to + last);
  }
  map.pixels.swap(smoothed_);
}

}  // namespace relievo
