// SPDX-License-Identifier: Apache-2.0
// Stereo layouts and their off-axis cameras: pure arithmetic, no GL.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

#include "app/scene/display_volume.h"
#include "hal/display.h"

namespace relievo {

enum class StereoLayout : std::uint8_t {
  Mono,
  SideBySide,    // left eye on the left
  TopBottom,     // left eye on top
  Rows,          // left eye in the first and every second row, for panels with line-wise polarisers
  Columns,       // left eye in the first and every second column
  Anaglyph,      // left eye red, right eye cyan
  FramePacking,  // HDMI 1.4a: left eye on top, a gap, right eye below; or the left eye's picture beside the right eye's
  Quilt,         // views from left to right in tiles, row by row from the bottom left
};
constexpr int kStereoLayouts = 8;
// mono sbs tab rows columns anaglyph frame-packing quilt
[[nodiscard]] const char* name(StereoLayout layout) noexcept;

enum class AnaglyphColors : std::uint8_t {
  Dubois,  // least-squares match to both eyes' colours through the glasses
  Color,   // plain channels: bright, but red objects strain the eyes
  Gray,    // no colour and no rivalry between the eyes
};

struct StereoSettings {
  static constexpr double kMostStrength = 2.0;

  StereoLayout layout = StereoLayout::SideBySide;
  // sbs and tab: each half keeps its aspect ratio, as on two screens; otherwise it is squeezed by half
  bool full = false;
  AnaglyphColors anaglyph = AnaglyphColors::Dubois;
  int quilt_cols = 8, quilt_rows = 6;
  double eye_distance_mm = 63.0;
  double strength = 1.0;             // factor on the distance of the eyes; 0: both see the same
  double viewing_distance_mm = 600;  // from the eyes to the screen plane
  double screen_z_mm = 20.0;         // the scene depth that lies in the screen plane: zero parallax
  bool swap_eyes = false;
  double zoom = 1.0;     // of the picture in its view; over 1 its edges are cut off
  double stretch = 1.0;  // factor on the picture's width over its height, for a film with the wrong shape
};

// A rectangle of a surface, from its bottom left as in GL.
struct PixelArea {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const PixelArea&) const = default;
};

struct EyeView {
  glm::dmat4 view_projection{1};
  PixelArea area;
  double eye_x_mm = 0;                           // x of the eye
  double half_width_mm = 0, half_height_mm = 0;  // of the camera's window
};

// The views of a layout, the left eye's first; mono is seen from between the eyes. The window of each camera is the
// picture's rectangle in the screen plane, letterboxed to the aspect ratio that its area will have for the viewer.
//
// Off-axis projection (never toed in): parallel axes and sheared frusta, so that there is no vertical parallax. For a
// point with h = z - screen_z, eye distance e and viewing distance d, the left eye's image lies x_left - x_right = e h
// / (d - h) to the right of the right eye's, in mm on the screen plane: crossed, and so in front of the screen, if h >
// 0; for the farthest points it tends to -e, parallel lines of sight.
struct EyeViews {
  std::vector<EyeView> views;
  // Rows, columns and anaglyph: each view is drawn over the whole surface, then both are mixed.
  bool mixed = false;
  double pixels_per_mm = 1;  // horizontal resolution of a view in the screen plane
  double aspect = 1;         // a view's width over its height as the viewer sees it
  // Pixels of a view beside the picture's rectangle, at each side; negative if its edges are cut off.
  int margin_x = 0, margin_y = 0;
};
[[nodiscard]] EyeViews eyeViews(const StereoSettings& settings, const DisplayVolume& volume, int width, int height);

// What each part of such a surface shows, for a mouse that points at it. In a mixed layout that is the view from midway
// between the eyes.
[[nodiscard]] SceneViews sceneViews(const StereoSettings& settings, const DisplayVolume& volume, int width, int height);

// Why this surface cannot show the layout, and what would help; null if it can.
[[nodiscard]] const char* refusal(const StereoSettings& settings, int width, int height) noexcept;

// The height error that shifts a point by one pixel between the eyes where the shift is largest, in mm.
[[nodiscard]] double heightOfPixelMm(const StereoSettings& settings, const DisplayVolume& volume,
                                     double pixels_per_mm) noexcept;

}  // namespace relievo
