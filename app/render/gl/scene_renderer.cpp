// SPDX-License-Identifier: Apache-2.0
// One frame: converts the picture, then draws the relief and the fingers for each eye.
#include "app/render/gl/scene_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/render/gl/color_picture.h"
#include "app/render/gl/eye_mixer.h"
#include "app/render/gl/finger_scene.h"
#include "app/render/gl/gl_objects.h"
#include "app/render/gl/reduced_view.h"
#include "app/render/gl/relief_surface.h"
#include "app/render/gl/words/overlay.h"
#include "app/render/gl/words/words_in_scene.h"
#include "app/render/relief/detail_level.h"
#include "app/render/relief/made_relief.h"
#include "app/render/relief/moving_average.h"
#include "app/scene/height_field.h"
#include "platform/clock.h"

namespace relievo {
namespace {

constexpr GLuint kPictureUnit = 3;  // after the colour planes' units
constexpr GLuint kRightUnit = 7;    // after the mixer's and the text's

PixelArea reducedBy(double size, PixelArea area) noexcept {
  area.width = std::max(1, static_cast<int>(std::lround(area.width * size)));
  area.height = std::max(1, static_cast<int>(std::lround(area.height * size)));
  return area;
}

}  // namespace

struct SceneRenderer::Impl {
  explicit Impl(Duration frame_budget) : level(frame_budget) {}
  [[nodiscard]] Result<void> createParts();

  [[nodiscard]] Result<void> drawViews(const DisplaySurface& surface, const FingerMarks& marks);
  void makeTriangles(const EyeViews& eyes);
  [[nodiscard]] Result<void> drawView(const EyeView& view, GLuint framebuffer, const FingerMarks& marks);
  void drawScene(const EyeView& view, const FingerMarks& marks);
  [[nodiscard]] Result<Duration> timeOf(const DisplaySurface& surface, const FingerMarks& marks);

  StereoSettings stereo;
  double error_px = kErrorPx;
  DisplayVolume volume;
  Frame depth;  // keeps the samples of `field` alive
  HeightField field;

  ColorPicture picture;
  ColorPicture right;  // of a film of two views
  bool has_right = false;
  MadeRelief relief;
  ReliefSurface relief_surface;
  EyeMixer mixer;
  ReducedView reduced;
  FingerScene finger;
  Overlay text;
  WordsInScene words;
  DetailLevel level;
  MonotonicClock clock;
  bool has_picture = false;
  MovingAverage drawing;
};

SceneRenderer::SceneRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneRenderer::~SceneRenderer() = default;

Result<void> SceneRenderer::Impl::createParts() {
  const auto take = [](auto& part, auto created) -> Result<void> {
    if (!created) return std::unexpected(created.error());
    part = std::move(*created);
    return {};
  };
  if (auto made_surface = take(relief_surface, ReliefSurface::create()); !made_surface) return made_surface;
  if (auto made_mixer = take(mixer, EyeMixer::create()); !made_mixer) return made_mixer;
  if (auto made_reduced = take(reduced, ReducedView::create()); !made_reduced) return made_reduced;
  if (auto made_text = take(text, Overlay::create()); !made_text) return made_text;
  if (auto made_words = take(words, WordsInScene::create()); !made_words) return made_words;
  if (auto made_finger = take(finger, FingerScene::create()); !made_finger) return made_finger;
  return glOutcome();
}

Result<std::unique_ptr<SceneRenderer>> SceneRenderer::create(Duration frame_budget) {
  auto impl = std::make_unique<Impl>(frame_budget);
  if (auto made = impl->createParts(); !made) return std::unexpected(made.error());
  return std::unique_ptr<SceneRenderer>(new SceneRenderer(std::move(impl)));
}

void SceneRenderer::setStereo(const StereoSettings& settings) noexcept {
  impl_->stereo = settings;
}

void SceneRenderer::setFrameBudget(Duration frame_budget) noexcept {
  impl_->level.setBudget(frame_budget);
}

void SceneRenderer::setError(double pixels) noexcept {
  impl_->error_px = pixels;
}

void SceneRenderer::setText(const TextFrame& frame, const std::vector<TextPicture>& pictures) {
  impl_->text.set(frame, pictures);
}

void SceneRenderer::setSubtitles(const TextFrame& frame, const std::vector<TextPicture>& pictures) {
  impl_->words.set(frame, pictures);
}

void SceneRenderer::cut() noexcept {
  impl_->words.cut();
}

void SceneRenderer::setAhead(const ReliefAhead& ahead) noexcept {
  impl_->words.setAhead(ahead);
}

Result<void> SceneRenderer::setFrame(const Frame& color, const Frame& depth, const DepthCalibration& calibration,
                                     const DisplayVolume& volume, const Frame& right) {
  Impl& impl = *impl_;
  if (auto drawable = ColorPicture::check(color); !drawable) return drawable;
  if (auto drawable = ColorPicture::check(right.empty() ? color : right); !drawable) return drawable;
  const auto field = depth.empty() ? HeightField() : HeightField::make(depth, calibration, volume);
  if (!field) return std::unexpected(field.error());
  if (auto set = impl.picture.setFrame(color); !set) return set;
  impl.has_right = !right.empty();
  if (impl.has_right) {
    if (auto set = impl.right.setFrame(right); !set) return set;
  }
  impl.field = *field;
  impl.depth = depth;  // keeps the samples of `field` alive, so both change together
  impl.volume = volume;
  impl.relief.forgetPicture();
  impl.words.newPicture();
  impl.has_picture = true;
  return glOutcome();
}

Result<void> SceneRenderer::draw(const DisplaySurface& surface, const FingerMarks& fingers,
                                 std::optional<Duration> late) {
  Impl& impl = *impl_;
  const auto took = impl.timeOf(surface, fingers);
  if (!took) return std::unexpected(took.error());
  impl.drawing.add(*took);
  if (!impl.depth.empty()) impl.level.drew(*took, late);
  return glOutcome();
}

Result<void> SceneRenderer::rehearse(const DisplaySurface& surface, const std::atomic<bool>& stop) {
  Impl& impl = *impl_;
  if (impl.depth.empty()) return {};
  const FingerMarks finger{FingerMark{{0, 0, impl.volume.depth_mm}, {0, 0, 1}, true}};
  impl.text.setUnseen({.width = surface.width, .height = surface.height});
  for (bool changed = true; changed;) {
    std::array<Duration, 3> took;  // the first compiles
    for (Duration& each : took) {
      if (stop) return {};
      const auto drawn = impl.timeOf(surface, finger);
      if (!drawn) return std::unexpected(drawn.error());
      each = *drawn;
    }
    changed = impl.level.rehearsed(std::min(took[1], took[2]));  // other work may have held one up
  }
  impl.text.set({}, {});
  return glOutcome();
}

std::vector<std::uint8_t> SceneRenderer::read(const DisplaySurface& surface) {
  const auto width = static_cast<std::size_t>(surface.width), height = static_cast<std::size_t>(surface.height);
  std::vector<std::uint8_t> rgba(4 * width * height), rgb(3 * width * height);
  glBindFramebuffer(GL_FRAMEBUFFER, surface.framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, surface.width, surface.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* from = rgba.data() + 4 * width * (height - 1 - y);
    for (std::size_t x = 0; x < width; ++x) std::copy_n(from + 4 * x, 3, rgb.data() + 3 * (y * width + x));
  }
  return rgb;
}

RenderStatistics SceneRenderer::statistics() const noexcept {
  const Impl& impl = *impl_;
  RenderStatistics result{.frames = impl.drawing.count(),
                          .imported = impl.picture.isImported(),
                          .size = impl.level.size(),
                          .frame_ms = toSeconds(impl.drawing.value()) * 1e3,
                          .behind_words_px = impl.words.place().behind()};
  if (impl.depth.empty()) return result;
  result.triangles = impl.relief.triangles().indices().size() / 3;
  result.cut_cells = impl.relief.triangles().cutCells();
  result.error_px = impl.error_px * impl.level.factor() / impl.level.size();
  result.mesh_ms = toSeconds(impl.relief.making()) * 1e3;
  return result;
}

Result<Duration> SceneRenderer::Impl::timeOf(const DisplaySurface& surface, const FingerMarks& marks) {
  const MonotonicTime start = clock.now();
  if (auto drawn = drawViews(surface, marks); !drawn) return std::unexpected(drawn.error());
  glFinish();
  return clock.now() - start;
}

Result<void> SceneRenderer::Impl::drawViews(const DisplaySurface& surface, const FingerMarks& marks) {
  StereoSettings shown = stereo;
  if (refusal(shown, surface.width, surface.height) != nullptr) shown.layout = StereoLayout::Mono;
  const EyeViews eyes = eyeViews(shown, volume, surface.width, surface.height);
  if (has_picture) {
    const PixelArea drawn = reducedBy(level.size(), eyes.views[0].area);
    picture.bind(kPictureUnit, drawn, volume);
    if (has_right) right.bind(kRightUnit, drawn, volume);
    if (depth.empty()) relief_surface.uploadFlat(volume, stereo.screen_z_mm);
    else makeTriangles(eyes);
    words.find(depth.empty() ? nullptr : &relief.triangles(), eyes, stereo);
  }
  const auto clear = [] {
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  };
  glBindFramebuffer(GL_FRAMEBUFFER, surface.framebuffer);
  clear();
  for (std::size_t i = 0; i < eyes.views.size(); ++i) {
    GLuint framebuffer = surface.framebuffer;
    if (eyes.mixed) {
      if (auto bound = mixer.bindEye(i, surface.width, surface.height); !bound) return bound;
      framebuffer = mixer.framebuffer(i);
      clear();
    }
    if (auto drawn = drawView(eyes.views[i], framebuffer, marks); !drawn) return drawn;
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  if (eyes.mixed) {
    glBindFramebuffer(GL_FRAMEBUFFER, surface.framebuffer);
    mixer.mix(shown);
  }
  return {};
}

// Makes the triangles for the present picture at the resolution of the views.
void SceneRenderer::Impl::makeTriangles(const EyeViews& eyes) {
  double eye_mm = 0;
  for (const EyeView& view : eyes.views) eye_mm = std::max(eye_mm, std::abs(view.eye_x_mm));
  const double pixels_per_mm = eyes.pixels_per_mm * level.size();
  const double pixel_mm = heightOfPixelMm(stereo, volume, pixels_per_mm);
  const ReliefDetail wanted{
      .most_across = ReliefDetail::cellsFor(pixels_per_mm * volume.width_mm, level.factor()),
      .error_mm = error_px * level.factor() * pixel_mm,
      .view = {.eye_mm = eye_mm, .distance_mm = stereo.viewing_distance_mm, .screen_z_mm = stereo.screen_z_mm}};
  if (relief.make(field, volume, wanted) || relief_surface.isFlat()) relief_surface.upload(relief.triangles());
}

// The scene may be drawn smaller, the words never are.
Result<void> SceneRenderer::Impl::drawView(const EyeView& view, GLuint framebuffer, const FingerMarks& marks) {
  const auto bindView = [&] {
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);  // keep the surface opaque whatever is blended on it
    glViewport(view.area.x, view.area.y, view.area.width, view.area.height);
  };
  if (has_picture && level.size() < 1) {
    const PixelArea small = reducedBy(level.size(), view.area);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    if (auto bound = reduced.bind(small.width, small.height); !bound) return bound;
    glViewport(0, 0, small.width, small.height);
    drawScene(view, marks);
    reduced.showOn(framebuffer, view.area);
    bindView();
  } else {
    bindView();
    if (has_picture) drawScene(view, marks);
  }
  if (has_picture) words.draw(view, stereo);
  text.draw(0);
  return {};
}

void SceneRenderer::Impl::drawScene(const EyeView& view, const FingerMarks& marks) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  // The relief is never seen from below, and the finger's shapes are closed.
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  const bool is_right = has_right && view.eye_x_mm > 0;
  relief_surface.draw(glm::mat4(view.view_projection), is_right ? kRightUnit : kPictureUnit);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i]) finger.draw(view.view_projection, depth.empty() ? nullptr : &field, *marks[i], kFingerPaints[i]);
  }
  glDisable(GL_CULL_FACE);
}

}  // namespace relievo
