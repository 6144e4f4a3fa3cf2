// SPDX-License-Identifier: Apache-2.0
// The sample film: its scene at any time, and its exact height.
#pragma once

namespace relievo {

struct SampleFilm {
  static constexpr int kCols = 720, kRows = 486;
  static constexpr int kFramesPerSecond = 30;
  static constexpr double kSeconds = 12.0;
  static constexpr double kCutSeconds = 8.0;  // the one hard cut: the frame at this time shows the second scene
  static constexpr int kFrames = 360;
  static constexpr double kWidthMm = 160.0, kHeightMm = 108.0, kDepthMm = 40.0;
};

// The height in mm of the surface at (x, y) of the scene frame, |x| <= 80, |y| <= 54, at time t of the film (clamped to
// its length). Not quantised: a depth code of the film is round(255 height / 40). Thread-safe.
[[nodiscard]] double sampleSceneHeight(double x_mm, double y_mm, double t_s) noexcept;

}  // namespace relievo
