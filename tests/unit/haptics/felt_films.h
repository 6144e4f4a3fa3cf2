// SPDX-License-Identifier: Apache-2.0
// Films of known heights for the surface of the default method.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec2.hpp>
#include <vector>

#include "app/depth_window/shots.h"
#include "app/haptics/method/felt_surface.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {

inline constexpr DisplayVolume kVolume{160, 108, 40};
inline constexpr int kCols = 360, kRows = 243;
inline constexpr double kPeriod = 1.0 / 30;

template <class Height>
inline std::vector<Frame> film(int count, Height&& height, int cols = kCols, int rows = kRows) {
  return test::makeReliefFilm(count, kPeriod, cols, rows, kVolume, height);
}

// Frames that come together are read in so many ticks: one in each of the first two, and then 8 blocks of a level.
inline constexpr int kTicksToRead = 2 + 4 * 32 / 8;
inline void readAll(FeltSurface& s, const SurfaceWindow& w, double t, double x = 0, double y = 0) {
  for (int tick = 0; tick < kTicksToRead; ++tick) {
    ASSERT_TRUE(s.moveTo(w, mediaTime(t)));
    static_cast<void>(s.at(x, y));
    s.prepare(w, mediaTime(t), x, y);
  }
}

// Bumps, noise and a step: hard cases for derivatives.
inline double rough(double x, double y, double t) {
  const double step = x > 10 + 0.3 * y ? 12 : 0;
  return 12 + 3 * std::sin(0.3 * x + 2 * t) * std::cos(0.25 * y) + step + 0.1 * std::sin(57 * x + 91 * y);
}

}  // namespace relievo
