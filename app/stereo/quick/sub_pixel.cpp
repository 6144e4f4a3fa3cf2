// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/sub_pixel.h"

#include <algorithm>
#include <cmath>

namespace relievo {
namespace {

constexpr int kRounds = 2;
constexpr int kReach = 4;          // pixels around, each of which says where the surface lies
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

}  // namespace

void SubPixel::refine(DisparityMap& map, const ViewPicture& left, const ViewPicture& right) {
  lumaOf(left, left_);
  lumaOf(right, right_);
  slopes_.resize(map.size());
  misfits_.resize(map.size());
  smooth(map, true, kTerrace);
  smooth(map, false, kTerrace);
  for (int i = 0; i < kRounds; ++i) {
    for (int r = 0; r < map.rows; ++r) compare(map, r);
    step(map);
    smooth(map, true, kSurface);
    smooth(map, false, kSurface);
  }
}

// Each pixel with what the right view has at its disparity.
void SubPixel::compare(const DisparityMap& map, int r) {
  const float* const left = &left_[map.at(0, r)];
  const float* const right = &right_[map.at(0, r)];
  for (int c = 0; c < map.cols; ++c) {
    const std::size_t i = map.at(c, r);
    const float x = static_cast<float>(c) - map.pixels[i];
    slopes_[i] = misfits_[i] = 0;
    if (map.seen[i] == 0 || c == 0 || c + 1 == map.cols || x < 1 || x >= static_cast<float>(map.cols - 2)) continue;
    const int whole = static_cast<int>(x);
    const float rest = x - static_cast<float>(whole);
    const float* const there = right + whole;
    const float shown = there[0] + rest * (there[1] - there[0]);
    const float slope_there = (1 - rest) * (there[1] - there[-1]) + rest * (there[2] - there[0]);
    const float slope = 0.25F * (slope_there + left[c + 1] - left[c - 1]);  // of both views
    const float misfit = left[c] - shown;
    const float weight = kWild * kWild / (kWild * kWild + misfit * misfit);
    slopes_[i] = weight * slope * slope;
    misfits_[i] = weight * slope * misfit;
  }
}

// Sums over squares around each pixel, by those of columns.
void SubPixel::step(DisparityMap& map) {
  const auto cols = static_cast<std::size_t>(map.cols);
  column_slopes_.assign(cols, 0);
  column_misfits_.assign(cols, 0);
  const auto add = [&](int r, float sign) {
    if (r < 0 || r >= map.rows) return;
    for (std::size_t c = 0; c < cols; ++c) {
      column_slopes_[c] += sign * slopes_[map.at(0, r) + c];
      column_misfits_[c] += sign * misfits_[map.at(0, r) + c];
    }
  };
  for (int r = 0; r < kReach; ++r) add(r, 1);
  for (int r = 0; r < map.rows; ++r) {
    add(r + kReach, 1);
    add(r - kReach - 1, -1);
    float slope = 0, misfit = 0;
    for (int c = -kReach; c < map.cols; ++c) {
      if (c + kReach < map.cols) {
        slope += *(column_slopes_.data() + c + kReach);
        misfit += *(column_misfits_.data() + c + kReach);
      }
      if (c > kReach) {
        slope -= *(column_slopes_.data() + c - kReach - 1);
        misfit -= *(column_misfits_.data() + c - kReach - 1);
      }
      if (c < 0 || map.seen[map.at(c, r)] == 0) continue;
      map.pixels[map.at(c, r)] -= std::clamp(misfit / (slope + kFlat), -kFarthest, kFarthest);
    }
  }
}

// Along rows, or down columns.
void SubPixel::smooth(DisparityMap& map, bool across, float surface) {
  smoothed_ = map.pixels;
  const std::ptrdiff_t stride = across ? 1 : map.cols;
  const int margin_c = across ? kNear : 0, margin_r = across ? 0 : kNear;
  for (int r = margin_r; r < map.rows - margin_r; ++r) {
    const float* const from = &map.pixels[map.at(margin_c, r)];
    float* const to = &smoothed_[map.at(margin_c, r)];
    const int count = map.cols - 2 * margin_c;
    sums_.assign(static_cast<std::size_t>(count), 0);
    weights_.assign(static_cast<std::size_t>(count), 0);
    float* const sums = sums_.data();
    float* const weights = weights_.data();
    for (int k = -kNear; k <= kNear; ++k) {  // a neighbour at a time, for all of the row
      const float* const near = from + k * stride;
      for (int c = 0; c < count; ++c) {
        const float weight = std::max(0.0F, surface - std::abs(near[c] - from[c]));
        sums[c] += weight * near[c];
        weights[c] += weight;
      }
    }
    for (int c = 0; c < count; ++c) to[c] = sums[c] / weights[c];
  }
  map.pixels.swap(smoothed_);
}

}  // namespace relievo
