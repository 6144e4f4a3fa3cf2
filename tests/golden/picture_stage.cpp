// SPDX-License-Identifier: Apache-2.0
// Draws, reads pixels back and measures them.
#include "tests/golden/picture_stage.h"

#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>

#include "drivers/egl/egl.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {

Spot Image::centroid(int c, int x0, int x1) const {
  Spot spot;
  for (int y = 0; y < height; ++y) {
    for (int x = x0; x < x1; ++x) {
      const double light = channel(x, y, c) / 255.0;
      spot.x += light * (x + 0.5);
      spot.y += light * (y + 0.5);
      spot.weight += light;
    }
  }
  spot.x /= spot.weight;
  spot.y /= spot.weight;
  return spot;
}

double Image::meanDifference(const Image& other) const {
  double sum = 0;
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    if (i % 4 != 3) sum += std::abs(rgba[i] - other.rgba[i]);
  }
  return sum / (0.75 * static_cast<double>(rgba.size()));
}

std::unique_ptr<Stage> Stage::make(int width, int height) {
  auto stage = std::make_unique<Stage>();
  stage->display_ = makeOffscreenDisplay({}, stage->clock_);
  auto opened = stage->display_->open({width, height});
  if (!opened && opened.error().code == ErrorCode::Unsupported) return nullptr;
  EXPECT_TRUE(opened) << opened.error().message;
  auto surface = stage->display_->beginFrame();
  EXPECT_TRUE(surface);
  stage->surface_ = *surface;
  // A budget so large that a slow machine never coarsens the relief.
  auto renderer = SceneRenderer::create(std::chrono::hours(1));
  EXPECT_TRUE(renderer) << renderer.error().message;
  stage->renderer_ = std::move(*renderer);
  return stage;
}

Stage::~Stage() {
  renderer_.reset();
  if (display_) display_->close();
}

Result<void> Stage::tryShow(const Scene& scene) {
  renderer_->setStereo(scene.stereo);
  renderer_->setError(scene.error_px);
  if (auto set = renderer_->setFrame(scene.color, scene.depth, scene.calibration, scene.volume, scene.right); !set) {
    return set;
  }
  return renderer_->draw(surface_, {scene.finger, scene.second_finger});
}

Image Stage::show(const Scene& scene) {
  const auto shown = tryShow(scene);
  EXPECT_TRUE(shown) << shown.error().message;
  return read();
}

Image Stage::again() {
  EXPECT_TRUE(renderer_->draw(surface_, {}));
  return read();
}

Image Stage::read() const {
  Image image{surface_.width, surface_.height, {}};
  const std::size_t row_bytes = static_cast<std::size_t>(image.width) * 4;
  std::vector<std::uint8_t> bottom_up(row_bytes * image.height);
  glBindFramebuffer(GL_FRAMEBUFFER, surface_.framebuffer);
  glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, bottom_up.data());
  for (int y = image.height - 1; y >= 0; --y) {
    const auto row = bottom_up.begin() + static_cast<std::ptrdiff_t>(y * row_bytes);
    image.rgba.insert(image.rgba.end(), row, row + static_cast<std::ptrdiff_t>(row_bytes));
  }
  return image;
}

Frame makeRgbFrame(int width, int height, const std::function<Rgb(int, int)>& color, const PackedLayout& layout) {
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(width) * layout.step + layout.padding;
  auto bytes = std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(stride * height), 0xcd);
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.model = ColorModel::Rgb;
  frame.plane_count = 1;
  frame.planes[0] = {bytes->data(), stride};
  if (layout.upside_down) frame.planes[0] = {bytes->data() + stride * (height - 1), -stride};
  for (int y = 0; y < height; ++y) {
    std::uint8_t* row = bytes->data() + stride * (layout.upside_down ? height - 1 - y : y);
    for (int x = 0; x < width; ++x) {
      const Rgb rgb = color(x, y);
      for (std::size_t c = 0; c < 3; ++c) row[x * layout.step + layout.offsets[c]] = static_cast<std::uint8_t>(rgb[c]);
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    frame.components[c] = {.offset_bytes = static_cast<std::uint8_t>(layout.offsets[c]),
                           .step_bytes = static_cast<std::uint8_t>(layout.step)};
  }
  frame.owner = bytes;
  return frame;
}

Frame makePlane(int cols, int rows, int bits, std::uint32_t code) {
  return makeGrayFrame(cols, rows, bits, MediaTime{}, [code](int, int) { return code; });
}

}  // namespace relievo::test
