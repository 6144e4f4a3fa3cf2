// SPDX-License-Identifier: Apache-2.0
// A scene as recordings hold it: distances in mm with a part that the camera does not see, a photo with texture, and
// colours that code a depth.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace relievo::test {

inline constexpr int kSceneCols = 160, kSceneRows = 108;

// A ball 200 mm wide in front of a wall inclined from 1.6 to 2 m; 0 in the left tenth, where the camera sees nothing.
inline double distanceMm(int c, int r) {
  if (c < kSceneCols / 10) return 0;
  const double x = 5.0 * (c - kSceneCols / 2), y = 5.0 * (r - kSceneRows / 2);
  const double square = 200 * 200 - x * x - y * y;
  return square > 0 ? 1300 - std::sqrt(square) : 1600 + 400.0 * c / kSceneCols;
}

// Red, green and blue, 0 to 1. No two places look alike.
inline std::array<double, 3> photoOf(int c, int r) {
  const double spots = std::sin(0.9 * c + 3 * std::sin(0.11 * r)) * std::sin(0.8 * r + 2 * std::sin(0.07 * c));
  return {0.5 + 0.35 * spots, 0.45 + 0.25 * std::sin(0.3 * c + 0.013 * c * r / 8.0),
          0.4 + 0.3 * std::cos(0.2 * r + 0.05 * c)};
}

// The standard hexagon at saturation and value 1; hue 0 to 1.
inline std::array<double, 3> hueColor(double hue) {
  const auto ramp = [&](double n) {
    const double k = std::fmod(n + 6 * hue, 6);
    return 1 - std::clamp(std::min(k, 4 - k), 0.0, 1.0);
  };
  return {ramp(5), ramp(3), ramp(1)};
}

// A pixel's code of component k in limited BT.601.
inline std::uint32_t yuvCode(int k, const std::array<double, 3>& color) {
  const double y = 0.299 * color[0] + 0.587 * color[1] + 0.114 * color[2];
  const double codes[] = {16 + 219 * y, 128 + 224 * (color[2] - y) / 1.772, 128 + 224 * (color[0] - y) / 1.402};
  return static_cast<std::uint32_t>(std::lround(codes[k]));
}

}  // namespace relievo::test
