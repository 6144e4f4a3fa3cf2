// SPDX-License-Identifier: Apache-2.0
// One frame: the picture converted, then for each eye the relief and the finger.
#include "app/render/scene_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "app/render/color_picture.h"
#include "app/render/finger_model.h"
#include "app/render/gl_objects.h"
#include "app/render/grid_step.h"
#include "app/render/relief_mesh.h"
#include "platform/clock.h"

namespace relievo {
namespace {

constexpr GLuint kPictureUnit = 3;  // after the codes' and the colour planes'

struct Rectangle {
  int x, y, width, height;
};

Rectangle pixelsOf(const EyeView& view, const DisplaySurface& surface) noexcept {
  const auto edge = [](double fraction, int size) { return static_cast<int>(std::lround(fraction * size)); };
  const int x = edge(view.x, surface.width);
  const int y = edge(view.y, surface.height);
  return {x, y, edge(view.x + view.width, surface.width) - x, edge(view.y + view.height, surface.height) - y};
}

}  // namespace

struct SceneRenderer::Impl {
  Impl(ReliefMesh made_relief, FingerModel made_finger, Duration frame_budget)
      : relief(std::move(made_relief)), finger(std::move(made_finger)), grid_step(frame_budget) {}

  void drawViews(const DisplaySurface& surface, const std::optional<FingerMark>& mark);
  void drawView(const EyeView& view, const std::optional<FingerMark>& mark) const;
  void bindPicture(const DisplaySurface& surface, const EyeView& view);

  StereoSettings stereo;
  DisplayVolume volume;
  ColorPicture picture;
  ReliefMesh relief;
  FingerModel finger;
  GridStep grid_step;
  MonotonicClock clock;
  bool has_picture = false;
  bool has_depth = false;
  std::uint64_t frames = 0;
  Duration smoothed{0};
};

SceneRenderer::SceneRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneRenderer::~SceneRenderer() = default;

Result<std::unique_ptr<SceneRenderer>> SceneRenderer::create(Duration frame_budget) {
  auto relief = ReliefMesh::create();
  if (!relief) return std::unexpected(relief.error());
  auto finger = FingerModel::create();
  if (!finger) return std::unexpected(finger.error());
  if (auto outcome = glOutcome(); !outcome) return std::unexpected(outcome.error());
  auto impl = std::make_unique<Impl>(std::move(*relief), std::move(*finger), frame_budget);
  return std::unique_ptr<SceneRenderer>(new SceneRenderer(std::move(impl)));
}

void SceneRenderer::setStereo(const StereoSettings& settings) noexcept {
  impl_->stereo = settings;
}
const StereoSettings& SceneRenderer::stereo() const noexcept {
  return impl_->stereo;
}

Result<void> SceneRenderer::setFrame(const Frame& color, const Frame& depth, const DepthCalibration& calibration,
                                     const DisplayVolume& volume) {
  Impl& impl = *impl_;
  if (auto drawable = ColorPicture::check(color); !drawable) return drawable;
  if (!depth.empty()) {
    if (auto set = impl.relief.setDepth(depth, calibration, volume); !set) return set;
    impl.grid_step.setGrid(impl.relief.cols(), impl.relief.rows());
  }
  if (auto set = impl.picture.setFrame(color); !set) return set;
  impl.has_depth = !depth.empty();
  impl.has_picture = true;
  impl.volume = volume;
  return glOutcome();
}

Result<void> SceneRenderer::draw(const DisplaySurface& surface, const std::optional<FingerMark>& finger) {
  Impl& impl = *impl_;
  const MonotonicTime start = impl.clock.now();
  impl.drawViews(surface, finger);
  glFinish();
  const Duration took = impl.clock.now() - start;
  impl.smoothed = impl.frames == 0 ? took : impl.smoothed + (took - impl.smoothed) / 8;
  ++impl.frames;
  if (impl.has_depth) impl.grid_step.drew(took);
  return glOutcome();
}

RenderStatistics SceneRenderer::statistics() const noexcept {
  const Impl& impl = *impl_;
  RenderStatistics result{.frames = impl.frames, .frame_ms = toSeconds(impl.smoothed) * 1e3};
  if (!impl.has_depth) return result;
  result.grid_cols = GridStep::verticesAlong(impl.relief.cols(), impl.grid_step.step());
  result.grid_rows = GridStep::verticesAlong(impl.relief.rows(), impl.grid_step.step());
  return result;
}

void SceneRenderer::Impl::drawViews(const DisplaySurface& surface, const std::optional<FingerMark>& mark) {
  const EyeViews eyes = eyeViews(stereo, volume, static_cast<double>(surface.width) / surface.height);
  if (has_picture) bindPicture(surface, eyes.views[0]);

  glBindFramebuffer(GL_FRAMEBUFFER, surface.framebuffer);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (!has_picture) return;

  glEnable(GL_DEPTH_TEST);
  // Nobody sees the relief from below, and the finger's shapes are closed.
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  for (std::size_t i = 0; i < static_cast<std::size_t>(eyes.count); ++i) {
    const EyeView& view = eyes.views[i];
    const Rectangle pixels = pixelsOf(view, surface);
    glViewport(pixels.x, pixels.y, pixels.width, pixels.height);
    // The surface stays opaque whatever the picture's fourth number is.
    glColorMask(view.channels[0], view.channels[1], view.channels[2], GL_FALSE);
    const bool over_the_first = i > 0 && view.x == eyes.views[0].x;
    if (over_the_first) glClear(GL_DEPTH_BUFFER_BIT);
    drawView(view, mark);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

// The picture's size on the surface is its window's, less the bars.
void SceneRenderer::Impl::bindPicture(const DisplaySurface& surface, const EyeView& view) {
  const double surface_aspect = static_cast<double>(surface.width) / surface.height;
  const double picture_aspect = volume.width_mm / volume.height_mm;
  const Rectangle pixels = pixelsOf(view, surface);
  picture.bind(kPictureUnit, static_cast<int>(pixels.width * std::min(1.0, picture_aspect / surface_aspect)),
               static_cast<int>(pixels.height * std::min(1.0, surface_aspect / picture_aspect)));
}

// Half-colour anaglyph: the red eye gets the picture's brightness in place of its red, so that a red or a blue thing is
// not bright for one eye and black for the other; the other eye keeps the colours that it can.
void SceneRenderer::Impl::drawView(const EyeView& view, const std::optional<FingerMark>& mark) const {
  const bool red_alone = view.channels[0] && !view.channels[1];
  if (red_alone) picture.showBrightnessAsRed(kPictureUnit);
  const PictureView picture_view{.view_projection = glm::mat4(view.view_projection),
                                 .screen_z_mm = stereo.screen_z_mm,
                                 .picture_unit = kPictureUnit};
  if (has_depth) {
    relief.draw(picture_view, grid_step.step());
  } else {
    relief.drawFlat(picture_view, volume);
  }
  if (red_alone) picture.showColors(kPictureUnit);
  if (mark) finger.draw(view.view_projection, *mark, red_alone);
}

}  // namespace relievo
