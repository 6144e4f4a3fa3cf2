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
  stage->renderer_->setStereo({.layout = StereoLayout::SideBySide});
  return stage;
}

DrawingStage::~DrawingStage() {
  renderer_.reset();  // its GL names go with the display's context
  display_.close();
}

Outcome<Duration> DrawingStage::show(const Frame& color, const Frame& depth, const DetailSettings& detail) {
  renderer_->setDetail(detail);
  const MonotonicTime start = clock_.now();
  const auto volume = DisplayVolume::forPicture(depth.width, depth.height);
  if (auto set = renderer_->setFrame(color, depth, {}, volume); !set) return failOn(kThing, set.error());
  if (auto drawn = renderer_->draw(surface_, std::nullopt); !drawn) return failOn(kThing, drawn.error());
  return clock_.now() - start;
}

Outcome<Duration> DrawingStage::again() {
  const MonotonicTime start = clock_.now();
  if (auto drawn = renderer_->draw(surface_, std::nullopt); !drawn) return failOn(kThing, drawn.error());
  return clock_.now() - start;
}

Picture DrawingStage::picture() const {
  Picture picture{surface_.width, surface_.height, {}};
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
