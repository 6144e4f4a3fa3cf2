// SPDX-License-Identifier: Apache-2.0
// A still scene whose inverse depth is known exactly, seen by one moving camera; and how steady a relief of it is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/film/two_views.h"

namespace relievo::test {

// A floor that rises towards the viewer, and boxes before it; inverse depth from kFar to kNear.
struct StillScene {
  static constexpr double kFar = 0.1, kNear = 0.9;
  std::uint32_t seed = 1;

  [[nodiscard]] double depth(double u, double v) const {
    const double i = std::floor(u / 47), j = std::floor(v / 39);
    const double share = smoothNoise(i + 0.31, j + 0.17, seed + 7) + 0.5;
    const bool box = u - 47 * i > 14 && v - 39 * j > 11 && share > 0.35;
    const double floor = kFar + 0.4 * std::clamp((v + 60) / 240, 0.0, 1.0);
    return box ? std::min(floor + 0.15 + 0.5 * (share - 0.35), kNear) : floor;
  }
  [[nodiscard]] double light(double u, double v) const {
    const double texture = 90 * smoothNoise(u / 5, v / 5, seed) + 60 * smoothNoise(u / 13, v / 13, seed + 1);
    return std::clamp(60 + 200 * depth(u, v) + texture, 0.0, 255.0);
  }
};

// The place of the scene in the middle of the picture, and how much of the scene a sample is.
struct StillCamera {
  double u = 0, v = 0, unit = 1;
};
inline StillCamera pan(int k) {
  return {.u = 1.37 * k, .v = -0.43 * k};
}
inline StillCamera zoom(int k) {
  return {.u = 40, .v = 20, .unit = 1 / std::pow(1.006, k)};
}
inline StillCamera stand(int) {
  return {};
}

struct StillView {
  int cols = 0, rows = 0;
  std::vector<std::uint8_t> light;
  std::vector<double> depth;  // inverse

  StillView(const StillScene& scene, const StillCamera& camera, int width, int height) : cols(width), rows(height) {
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        const double u = camera.u + camera.unit * (c - 0.5 * cols), v = camera.v + camera.unit * (r - 0.5 * rows);
        light.push_back(static_cast<std::uint8_t>(scene.light(u, v)));
        depth.push_back(scene.depth(u, v));
      }
    }
  }
};

// The relief's heights at the scene's farthest and nearest depth, from a line fitted by least squares to the samples
// with heights from `low` to `high`.
struct ReliefEnds {
  double far = 0, near = 0;
  double rest = 0;  // standard deviation of the samples from that line
};
template <class Value>
ReliefEnds endsOf(const StillView& view, Value value, double low, double high) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < view.depth.size(); ++i) {
    const double h = value(i), d = view.depth[i];
    if (h < low || h > high) continue;
    n += 1;
    x += d;
    y += h;
    xx += d * d;
    xy += d * h;
    yy += h * h;
  }
  const double vx = xx / n - x * x / (n * n), vxy = xy / n - x * y / (n * n), vy = yy / n - y * y / (n * n);
  const double slope = vxy / vx, level = y / n - slope * x / n;
  return {level + slope * StillScene::kFar, level + slope * StillScene::kNear,
          std::sqrt(std::max(vy - slope * vxy, 0.0))};
}
// For a relief of 16 bits whose heights are linear from 15 to 85 % of the codes.
inline ReliefEnds endsOf(const StillView& view, const Frame& relief) {
  const auto share = [&](std::size_t i) {
    const Plane& plane = relief.planes[0];
    const int c = static_cast<int>(i) % view.cols, r = static_cast<int>(i) / view.cols;
    return codeAt(relief.components[0], plane.data + r * plane.stride_bytes + std::ptrdiff_t{2} * c) / 65535.0;
  };
  return endsOf(view, share, 0.16, 0.84);
}

// How much the nearest and the farthest depth of a still scene change, as shares of the relief: from picture to picture
// (flicker, rms), and from the mean of the first eight pictures to that of the last eight (drift).
struct Unrest {
  double flicker = 0, drift = 0;
};
inline Unrest unrestOf(const std::vector<ReliefEnds>& ends) {
  constexpr std::size_t kMany = 8;
  Unrest unrest;
  const double relief = ends.front().near - ends.front().far;
  for (double ReliefEnds::* end : {&ReliefEnds::far, &ReliefEnds::near}) {
    double squares = 0, first = 0, last = 0;
    for (std::size_t k = 1; k < ends.size(); ++k) squares += std::pow(ends[k].*end - ends[k - 1].*end, 2);
    for (std::size_t k = 0; k < kMany; ++k) {
      first += ends[k].*end / kMany;
      last += ends[ends.size() - 1 - k].*end / kMany;
    }
    unrest.flicker = std::max(unrest.flicker, std::sqrt(squares / static_cast<double>(ends.size() - 1)) / relief);
    unrest.drift = std::max(unrest.drift, std::abs(last - first) / relief);
  }
  return unrest;
}

}  // namespace relievo::test
