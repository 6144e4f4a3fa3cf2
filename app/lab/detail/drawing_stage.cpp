// SPDX-License-Identifier: Apache-2.0
// A framebuffer that is never presented: it is read back.
#include "app/lab/detail/drawing_stage.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace relievo {
namespace {

constexpr const char* kThing = "drawing";
constexpr StereoSettings kStereo{.layout = StereoLayout::SideBySide};

}  // namespace

Outcome<std::unique_ptr<DrawingStage>> DrawingStage::open(Display& display, int width, int height) {
  std::unique_ptr<DrawingStage> stage(new DrawingStage(display));
  if (auto opened = display.open({width, height}); !opened) return failOn(kThing, opened.error());
  auto surface = display.beginFrame();
  if (!surface) return failOn(kThing, surface.error());
  stage->surface_ = *surface;
  constexpr Duration kWithoutHaste = std::chrono::hours(1);  // a slow machine draws no coarser relief
  auto renderer = SceneRenderer::create(kWithoutHaste);
  if (!renderer) return failOn(kThing, renderer.error());
  stage->renderer_ = std::move(*renderer);
  stage->renderer_->setStereo(kStereo);
  auto grid = UniformGrid::create();
  if (!grid) return failOn(kThing, grid.error());
  stage->grid_ = std::move(*grid);
  return stage;
}

DrawingStage::~DrawingStage() {
  grid_.reset();  // their GL names go with the display's context
  renderer_.reset();
  display_.close();
}

Outcome<Duration> DrawingStage::show(const Frame& color, const Frame& depth, const DrawnLevel& level) {
  level_ = level;
  const MonotonicTime start = clock_.now();
  if (auto taken = take(color, depth); !taken) return failOn(kThing, taken.error());
  if (auto drawn = draw(); !drawn) return failOn(kThing, drawn.error());
  return clock_.now() - start;
}

Outcome<Duration> DrawingStage::again() {
  const MonotonicTime start = clock_.now();
  if (auto drawn = draw(); !drawn) return failOn(kThing, drawn.error());
  return clock_.now() - start;
}

Result<void> DrawingStage::take(const Frame& color, const Frame& depth) {
  const auto volume = DisplayVolume::forPicture(depth.width, depth.height);
  if (level_.grid_step > 0) return grid_->setFrame(color, depth, volume);
  renderer_->setError(level_.error_px);
  return renderer_->setFrame(color, depth, {}, volume);
}

Result<void> DrawingStage::draw() {
  return level_.grid_step > 0 ? grid_->draw(surface_, kStereo, level_.grid_step) : renderer_->draw(surface_, {});
}

DrawnPicture DrawingStage::picture() const {
  DrawnPicture picture{surface_.width, surface_.height, {}};
  const std::size_t row_bytes = static_cast<std::size_t>(picture.width) * 4;
  std::vector<std::uint8_t> bottom_up(row_bytes * static_cast<std::size_t>(picture.height));
  glBindFramebuffer(GL_FRAMEBUFFER, surface_.framebuffer);
  glReadPixels(0, 0, picture.width, picture.height, GL_RGBA, GL_UNSIGNED_BYTE, bottom_up.data());
  picture.rgba.resize(bottom_up.size());
  for (std::size_t from = 0, to = bottom_up.size(); from < bottom_up.size(); from += row_bytes) {
    to -= row_bytes;
    std::copy_n(bottom_up.data() + from, row_bytes, picture.rgba.data() + to);
  }
  return picture;
}

}  // namespace relievo
