// SPDX-License-Identifier: Apache-2.0
// A relief given by a formula, as each eye sees it along rays. Shares no code with the renderer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/lab/detail/picture_quality.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {

inline constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};
inline constexpr double kDistance = 600, kScreenZ = 20, kEyes = 63;

inline double relief(double x, double y) {
  return 6 + 26 * std::exp(-((x - 15) * (x - 15) + y * y) / (2 * 28.0 * 28.0)) + 0.03 * x;
}

// Smooth enough to be insensitive to antialiasing, yet a shift of one pixel is detected.
inline Rgb paint(double x, double y) {
  const auto wave = [](double phase) { return static_cast<int>(std::lround(127.5 + 120 * std::sin(phase))); };
  return {wave(1.5 * x + 0.2 * y), wave(1.1 * x - 0.5 * y), wave(0.9 * (x + y) + 2)};
}

// The colour that an eye at (eye_x, 0, 620) sees through the point (x, y, 20) of the screen plane. A ray moves sideways
// by at most 0.36 mm per mm of depth, and the relief is no steeper than 0.6, so that the ray meets it once. Each
// iteration comes at least four times closer to that point: from 40 mm to 1e-8 mm.
inline Rgb seen(double eye_x, double x, double y) {
  const auto along = [](double z) { return (kDistance + kScreenZ - z) / kDistance; };
  const auto across = [&](double z) { return eye_x + (x - eye_x) * along(z); };
  double z = kScreenZ;
  for (int i = 0; i < 16; ++i) z = relief(across(z), y * along(z));
  return paint(across(z), y * along(z));
}

// An eye's picture of the whole window, `width` x `height` pixels.
inline DrawnPicture view(double eye_x, int width, int height) {
  DrawnPicture picture{width, height, {}};
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const double x = ((c + 0.5) / width - 0.5) * kVolume.width_mm, y = (0.5 - (r + 0.5) / height) * kVolume.height_mm;
      for (const int value : seen(eye_x, x, y)) picture.rgba.push_back(static_cast<std::uint8_t>(value));
      picture.rgba.push_back(255);
    }
  }
  return picture;
}

inline void paste(const DrawnPicture& part, int x, int y, DrawnPicture& whole) {
  for (int r = 0; r < part.height; ++r) {
    std::copy_n(part.rgba.begin() + static_cast<std::ptrdiff_t>(r) * part.width * 4, part.width * 4,
                whole.rgba.begin() + (static_cast<std::ptrdiff_t>(y + r) * whole.width + x) * 4);
  }
}

inline DrawnPicture black(int width, int height) {
  DrawnPicture picture{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 4, 0)};
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
  return picture;
}

inline Scene sceneIn(const StereoSettings& stereo) {
  constexpr int kWidth = 1280, kHeight = 720;
  return {.color = makeRgbFrame(kWidth, kHeight,
                                [](int c, int r) {
                                  return paint(((c + 0.5) / kWidth - 0.5) * kVolume.width_mm,
                                               (0.5 - (r + 0.5) / kHeight) * kVolume.height_mm);
                                }),
          .depth = makeReliefFrame(640, 360, kVolume, MediaTime{}, relief),
          .calibration = {.bits = 16},
          .volume = kVolume,
          .stereo = stereo,
          .error_px = 0.5};
}

// At the picture's edge the relief is joined to the frame, so a few pixels there are ignored.
inline double similarity(const Image& image, const DrawnPicture& golden, int rim) {
  std::vector<std::uint8_t> counted(static_cast<std::size_t>(golden.width) * golden.height, 0);
  for (int r = rim; r < golden.height - rim; ++r) {
    for (int c = rim; c < golden.width - rim; ++c) counted[static_cast<std::size_t>(r) * golden.width + c] = 1;
  }
  PictureError error;
  error.add(differenceOf({image.width, image.height, image.rgba}, golden), counted);
  return error.similarity();
}

}  // namespace relievo::test
