// SPDX-License-Identifier: Apache-2.0
// A renderer on an offscreen display, the image it has drawn, and synthetic frames to draw.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/render/gl/scene_renderer.h"
#include "hal/display.h"
#include "hal/media/frame.h"
#include "platform/clock.h"

namespace relievo::test {

using Rgb = std::array<int, 3>;

struct Spot {
  double x = 0, y = 0;  // in pixels; the centre of the first pixel is (0.5, 0.5)
  double weight = 0;    // sum of the channel over 255
};

// Row 0 is at the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;

  [[nodiscard]] int channel(int x, int y, int c) const {
    return rgba[(static_cast<std::size_t>(y) * width + x) * 4 + c];
  }
  [[nodiscard]] Rgb at(int x, int y) const { return {channel(x, y, 0), channel(x, y, 1), channel(x, y, 2)}; }
  // The centroid of the light in one channel between columns x0 and x1.
  [[nodiscard]] Spot centroid(int c, int x0, int x1) const;
  // Mean absolute difference over the whole picture and its channels.
  [[nodiscard]] double meanDifference(const Image& other) const;
};

struct Scene {
  Frame color;
  Frame depth;
  DepthCalibration calibration;
  DisplayVolume volume;
  StereoSettings stereo{.layout = StereoLayout::Mono};
  std::optional<FingerMark> finger, second_finger;
  double error_px = 0.05;
  Frame right;  // of two views
};

class Stage {
 public:
  // Null if this machine has no EGL with GLES 3.
  [[nodiscard]] static std::unique_ptr<Stage> make(int width, int height);
  ~Stage();

  [[nodiscard]] Result<void> tryShow(const Scene& scene);
  // Fails the test if the scene cannot be shown.
  [[nodiscard]] Image show(const Scene& scene);
  // Draws the last scene again.
  [[nodiscard]] Image again();
  [[nodiscard]] bool rehearse(const std::atomic<bool>& stop = false) {
    return renderer_->rehearse(surface_, stop).has_value();
  }
  [[nodiscard]] SceneRenderer& renderer() { return *renderer_; }

 private:
  [[nodiscard]] Image read() const;

  ManualClock clock_;
  std::unique_ptr<Display> display_;
  std::unique_ptr<SceneRenderer> renderer_;
  DisplaySurface surface_;
};

// Declares `stage`, a reference.
// NOLINTBEGIN(bugprone-macro-parentheses)
#define STAGE_OR_SKIP(stage, width, height)                                  \
  const auto stage##_owner = ::relievo::test::Stage::make(width, height);    \
  if (!stage##_owner) GTEST_SKIP() << "this machine has no EGL with GLES 3"; \
  ::relievo::test::Stage& stage = *stage##_owner
// NOLINTEND(bugprone-macro-parentheses)

// Packed RGB or RGBA with the given byte offsets; rows are padded to `stride` if that is larger.
struct PackedLayout {
  int step = 3;
  std::array<int, 3> offsets{0, 1, 2};
  int padding = 0;
  bool upside_down = false;
};
[[nodiscard]] Frame makeRgbFrame(int width, int height, const std::function<Rgb(int, int)>& color,
                                 const PackedLayout& layout = {});

// A frame with a single depth code, in bytes up to 8 bits, in words above.
[[nodiscard]] Frame makePlane(int cols, int rows, int bits, std::uint32_t code);

}  // namespace relievo::test
