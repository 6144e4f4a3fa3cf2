// SPDX-License-Identifier: Apache-2.0
// Stereo layouts and the off-axis cameras behind them: pure arithmetic, no GL.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

#include "app/scene/display_volume.h"

namespace relievo {

enum class StereoLayout : std::uint8_t {
  Mono,
  SideBySide,    // left eye left
  TopBottom,     // left eye above
  Rows,          // left eye in the first row and every second one, for panels with a polariser on every line
  Columns,       // left eye in the first column and every second one
  Anaglyph,      // left eye red, right eye cyan
  FramePacking,  // HDMI 1.4a: left eye above, a gap, right eye below
  Quilt,         // views from left to right in tiles, from the bottom left one on, row by row
};
constexpr int kStereoLayouts = 8;
// mono sbs tab rows columns anaglyph frame-packing quilt
[[nodiscard]] const char* name(StereoLayout layout) noexcept;

enum class AnaglyphColors : std::uint8_t {
  Dubois,  // the colours that come nearest to both eyes' through the glasses
  Color,   // each channel as it is: bright, and hard on the eyes where a thing is red
  Gray,    // no colour, and no quarrel between the eyes
};

struct StereoSettings {
  static constexpr double kMostStrength = 2.0;

  StereoLayout layout = StereoLayout::SideBySide;
  bool full = false;  // sbs and tab: each half keeps its shape, as on two screens; otherwise it is squeezed by half
  AnaglyphColors anaglyph = AnaglyphColors::Dubois;
  int quilt_cols = 8, quilt_rows = 6;
  double eye_distance_mm = 63.0;
  double strength = 1.0;             // of the depth: the eyes' distance is this much as large; 0: both see the same
  double viewing_distance_mm = 600;  // from the eyes to the screen plane
  double screen_z_mm = 20.0;         // the scene depth that lies in the screen plane: zero parallax
  bool swap_eyes = false;
};

// Of a surface, from its bottom left, as GL counts.
struct PixelArea {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const PixelArea&) const = default;
};

struct EyeView {
  glm::dmat4 view_projection{1};
  PixelArea area;
  double eye_x_mm = 0;  // where it looks from
};

// The views of a layout, the left eye's first; mono is seen from between the eyes. The window of each camera is the
// picture's rectangle in the screen plane, letterboxed into the shape that its area will have for the viewer.
//
// Off-axis projection (never toed in): parallel axes, sheared frusta, so that there is no vertical parallax. With
// h = z - screen_z of a point, e the eyes' distance and d theirs from the screen, the left eye's image of the point
// lies x_left - x_right = e h / (d - h) to the right of the right eye's, in mm on the screen plane: crossed, and so in
// front of the screen, where h > 0; for the farthest points it tends to -e, parallel lines of sight.
struct EyeViews {
  std::vector<EyeView> views;
  // Rows, columns and anaglyph: each view takes the whole surface, and both are then mixed into it.
  bool mixed = false;
  double pixels_per_mm = 1;  // across, of a view, in the screen plane
};
[[nodiscard]] EyeViews eyeViews(const StereoSettings& settings, const DisplayVolume& volume, int width, int height);

// Why this surface cannot show the layout, and what would; null when it can.
[[nodiscard]] const char* refusal(const StereoSettings& settings, int width, int height) noexcept;

// Of the shift between the eyes that a height error makes, where it is largest, as mm of height for one pixel.
[[nodiscard]] double heightOfPixelMm(const StereoSettings& settings, const DisplayVolume& volume,
                                     double pixels_per_mm) noexcept;

}  // namespace relievo
