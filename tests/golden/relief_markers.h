// SPDX-License-Identifier: Apache-2.0
// Marked points on a relief, and where each eye sees them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "app/scene/height_field.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {

// Half of a side-by-side surface is 640 x 720 and shows 160 x 90 mm: 4 pixels a mm across, 8 down.
inline constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};
inline constexpr int kSurfaceWidth = 1280, kSurfaceHeight = 720;
inline constexpr double kPixelsPerMmX = 4.0, kPixelsPerMmY = 8.0;
inline constexpr int kColorWidth = 640, kColorHeight = 360;
inline constexpr double kEyes = 63.0, kDistance = 600.0, kScreenZ = 20.0;

// A white square of 9 x 9 pixels on black, and the position of its middle in the scene.
struct Marker {
  int x, y;
  [[nodiscard]] double xMm() const { return ((x + 0.5) / kColorWidth - 0.5) * kVolume.width_mm; }
  [[nodiscard]] double yMm() const { return (0.5 - (y + 0.5) / kColorHeight) * kVolume.height_mm; }
};

inline Frame markerPicture(const Marker& marker) {
  return makeRgbFrame(kColorWidth, kColorHeight, [&](int x, int y) {
    const bool lit = std::abs(x - marker.x) <= 4 && std::abs(y - marker.y) <= 4;
    return lit ? Rgb{255, 255, 255} : Rgb{0, 0, 0};
  });
}

// The point where the ray from the eye through (x, y, z) meets the screen plane, in pixels of the eye's half from the
// top left.
struct Pixel {
  double x, y;
};
inline Pixel onScreen(double eye_x, double x, double y, double z) {
  const double grow = kDistance / (kDistance - (z - kScreenZ));
  return {(eye_x + (x - eye_x) * grow + 80.0) * kPixelsPerMmX, (45.0 - y * grow) * kPixelsPerMmY};
}

inline std::uint32_t code16(double z) {
  return static_cast<std::uint32_t>(std::lround(z / kVolume.depth_mm * 65535.0));
}

inline Scene sideBySide(const Marker& marker, Frame depth) {
  return {.color = markerPicture(marker),
          .depth = std::move(depth),
          .calibration = {.bits = 16},
          .volume = kVolume,
          .stereo = {.layout = StereoLayout::SideBySide}};
}

inline void expectMarker(const Image& image, const Marker& marker, double z) {
  const Spot left = image.centroid(0, 0, 640);
  const Spot right = image.centroid(0, 640, 1280);
  const Pixel left_paper = onScreen(-kEyes / 2, marker.xMm(), marker.yMm(), z);
  const Pixel right_paper = onScreen(kEyes / 2, marker.xMm(), marker.yMm(), z);
  EXPECT_NEAR(left.x, left_paper.x, 0.25);
  EXPECT_NEAR(right.x - 640, right_paper.x, 0.25);
  EXPECT_NEAR(left.y, left_paper.y, 0.25);
  EXPECT_NEAR(left.y, right.y, 0.05) << "vertical parallax";
  // x_left - x_right = e h / (d - h), to within a quarter of a pixel.
  const double h = z - kScreenZ;
  EXPECT_NEAR(left.x - (right.x - 640), kPixelsPerMmX * kEyes * h / (kDistance - h), 0.25);
}

}  // namespace relievo::test
