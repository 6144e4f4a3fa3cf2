// SPDX-License-Identifier: Apache-2.0
// Stereo layouts and the two off-axis cameras behind them: pure arithmetic, no GL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>

#include "app/scene/display_volume.h"

namespace relievo {

enum class StereoLayout : std::uint8_t { Mono, SideBySide, Anaglyph };
[[nodiscard]] const char* name(StereoLayout layout) noexcept;  // mono sbs anaglyph

struct StereoSettings {
  StereoLayout layout = StereoLayout::SideBySide;
  double eye_distance_mm = 63.0;     // 0: both eyes see the same
  double viewing_distance_mm = 600;  // from the eyes to the screen plane
  double screen_z_mm = 20.0;         // the scene depth that lies in the screen plane: zero parallax
  bool swap_eyes = false;
};

struct EyeView {
  glm::dmat4 view_projection{1};
  // The part of the surface, in fractions of it: x, y (from the bottom), width, height.
  double x = 0, y = 0, width = 1, height = 1;
  // For anaglyph: which colour channels this eye writes.
  std::array<bool, 3> channels{true, true, true};
};

// The views of a layout, one or two, the left eye's first: the left half of side by side, the red of anaglyph; mono is
// seen from between the eyes. The window of each camera is the picture's rectangle in the screen plane, letterboxed
// into `surface_aspect` (width over height of the whole surface; sbs squeezes each half to that shape).
//
// Off-axis projection (never toed in): parallel axes, sheared frusta, so that there is no vertical parallax. With
// h = z - screen_z of a point, e the eyes' distance and d theirs from the screen, the left eye's image of the point
// lies x_left - x_right = e h / (d - h) to the right of the right eye's, in mm on the screen plane: crossed, and so in
// front of the screen, where h > 0; for the farthest points it tends to -e, parallel lines of sight.
struct EyeViews {
  std::array<EyeView, 2> views;
  int count = 1;
};
[[nodiscard]] EyeViews eyeViews(const StereoSettings& settings, const DisplayVolume& volume, double surface_aspect);

}  // namespace relievo
