// SPDX-License-Identifier: Apache-2.0
// Draws, presents, and opens a lost display again.
#include "app/player/screen/picture.h"

#include <algorithm>

#include "app/player/screen/bar_script.h"
#include "app/player/screen/stereo_word.h"

namespace relievo {
namespace {

constexpr Duration kRetryPeriod = std::chrono::seconds(1);
constexpr double kMostZoom = 4;
constexpr const char* kBound =
    "the television expects this layout of the two pictures; start with --tv-signal off to choose another";

StereoLayout layoutOf(StereoSignal signal) noexcept {
  switch (signal) {
    case StereoSignal::FramePacking:
      return StereoLayout::FramePacking;
    case StereoSignal::SideBySideHalf:
      return StereoLayout::SideBySide;
    case StereoSignal::TopAndBottom:
      return StereoLayout::TopBottom;
    case StereoSignal::None:
      break;
  }
  return StereoLayout::Mono;
}

const char* notTaken(StereoSignal signal) noexcept {
  switch (signal) {
    case StereoSignal::FramePacking:
      return "the screen takes no frame packing; relievo devices lists its 3D signals";
    case StereoSignal::SideBySideHalf:
      return "the screen takes no side by side as a 3D signal; relievo devices lists those that it takes";
    default:
      return "the screen takes no top and bottom as a 3D signal; relievo devices lists those that it takes";
  }
}

}  // namespace

void Picture::close() noexcept {
  renderer_.reset();  // its GL objects die in the context that made them
  due_.uploaded = false;
  display_.close();
}

void Picture::setScene(const DepthCalibration& calibration, const DisplayVolume& volume,
                       Duration frame_budget) noexcept {
  calibration_ = calibration;
  volume_ = volume;
  frame_budget_ = frame_budget;
  if (renderer_ != nullptr) renderer_->setFrameBudget(frame_budget);
  rehearsal_.due = true;
}

void Picture::announce(const AnnouncedFilm& film) {
  film_ = film;
  display_.announce(film);
}

void Picture::setPair(const FramePair& pair, MediaTime place, std::optional<Duration> late) {
  due_ = {.pair = pair, .place = std::max(pair.color.pts, place), .late = late};
}

void Picture::clear() noexcept {
  setPair({});
  renderer_.reset();
}

Result<Picture::Shown> Picture::show(const FingerMarks& fingers, MonotonicTime now) {
  const bool was_away = away();
  if (was_away) {
    if (now < next_retry_) return Shown::NoScreen;
    next_retry_ = now + kRetryPeriod;
    if (!display_.open(config_)) return Shown::NoScreen;  // not back yet; the loss was already reported
    display_.announce(film_);
  }
  const auto drawn = drawAndPresent(fingers);
  if (drawn) return was_away ? Shown::Back : Shown::OnScreen;
  if (drawn.error().code != ErrorCode::Lost) return std::unexpected(drawn.error());
  lose(now);
  return was_away ? Shown::NoScreen : Shown::Lost;
}

void Picture::lose(MonotonicTime now) noexcept {
  close();
  next_retry_ = now + kRetryPeriod;
}

Result<bool> Picture::attend(MonotonicTime now) {
  if (away()) return false;
  auto attended = display_.attend();
  if (!attended && attended.error().code == ErrorCode::Lost) lose(now);
  return attended;
}

Result<void> Picture::drawAndPresent(const FingerMarks& fingers) {
  const auto surface = display_.beginFrame();
  if (!surface) return std::unexpected(surface.error());
  width_ = surface->width;
  height_ = surface->height;
  followSignal(*surface);
  fallBack(*surface);
  display_.setViews(sceneViews(stereo_, volume_, width_, height_));
  if (display_.capabilities().gles) {
    if (auto drawn = draw(*surface, fingers); !drawn) {
      static_cast<void>(display_.present());  // the frame that was begun ends, so that the display can be used again
      return drawn;
    }
  }
  const auto presented = display_.present();
  if (!presented) return std::unexpected(presented.error());
  return {};
}

Result<void> Picture::draw(const DisplaySurface& surface, const FingerMarks& fingers) {
  bool renewed = false;
  if (renderer_ == nullptr) {
    auto renderer = SceneRenderer::create(frame_budget_);
    if (!renderer) return std::unexpected(renderer.error());
    renderer_ = std::move(*renderer);
    renderer_->setStereo(stereo_);
    renewed = true;
  }
  if (!due_.uploaded && !due_.pair.color.empty()) {
    if (std::exchange(cut_, false)) renderer_->cut();
    auto set = renderer_->setFrame(due_.pair.color, due_.pair.depth, calibration_, volume_, due_.pair.right);
    if (!set) {
      due_ = {};  // not tried again: the picture before stays
      return set;
    }
    due_.uploaded = true;
  }
  renderer_->setAhead(ahead_);  // also for the rehearsal: what was ahead before may be gone
  if (due_.uploaded && std::exchange(rehearsal_.due, false)) {
    if (auto rehearsed = renderer_->rehearse(surface, *rehearsal_.stop); !rehearsed) return rehearsed;
    words_.forget();
  }
  layOutSubtitles();
  if (std::exchange(subtitles_changed_, false) || renewed) {
    renderer_->setSubtitles(textFrame(), subtitles_.pictures());
  }
  if (auto captured = captureFrom(surface, fingers); !captured) return captured;
  const TextFrame frame = textFrame();
  if (words_.draw(text_, frame) || renewed) renderer_->setText(frame, words_.pictures());
  if (auto drawn = renderer_->draw(surface, fingers, std::exchange(due_.late, Duration(0))); !drawn) return drawn;
  statistics_ = renderer_->statistics();
  return {};
}

bool Picture::subtitlesChange(MediaTime place) {
  constexpr Duration kStep = std::chrono::milliseconds(33);  // drawing text costs time, even if nothing has changed
  if (renderer_ == nullptr || place < due_.place + kStep) return false;
  due_.place = place;
  layOutSubtitles();
  return subtitles_changed_;
}

void Picture::layOutSubtitles() {
  const TextFrame frame = textFrame();
  const SubtitleRoom room{.none = !text_.keys.empty(), .down = roomForWords(text_, frame.aspect)};
  subtitles_changed_ |= subtitles_.draw(frame, due_.place, room);
}

Result<void> Picture::captureFrom(const DisplaySurface& surface, const FingerMarks& fingers) {
  if (!std::exchange(capture_due_, false)) return {};
  renderer_->setText({.width = 1, .height = 1}, {});
  if (auto drawn = renderer_->draw(surface, fingers, Duration(0)); !drawn) return drawn;
  captured_ = Capture{surface.width, surface.height, SceneRenderer::read(surface)};
  words_.forget();
  return {};
}

// The television splits the two pictures as the signal says. A surface of the size of frame packing needs no signal:
// its mode may have been set by the viewer.
void Picture::followSignal(const DisplaySurface& surface) noexcept {
  if (std::exchange(signal_, surface.stereo) != surface.stereo && signal_ != StereoSignal::None) {
    stereo_.layout = layoutOf(signal_);
    stereo_.full = false;
    stereoChanged();
  }
  const bool packed = config_.stereo == StereoSignal::FramePacking && stereo_.layout == StereoLayout::FramePacking &&
                      refusal(stereo_, surface.width, surface.height) == nullptr;
  if (signal_ == config_.stereo || !config_.other_stereo || packed || std::exchange(signal_told_, true)) return;
  refusal_ = notTaken(config_.stereo);
}

bool Picture::isBound() noexcept {
  if (signal_ == StereoSignal::None) return false;
  refusal_ = kBound;
  return true;
}

// A packed frame that no display takes was meant for a screen that shows two eyes; most of those can show side by side.
void Picture::fallBack(const DisplaySurface& surface) noexcept {
  const char* why = refusal(stereo_, surface.width, surface.height);
  if (why == nullptr) return;
  if (refusal_ == nullptr) refusal_ = why;
  const bool packed = stereo_.layout == StereoLayout::FramePacking;
  stereo_.layout = packed && surface.width > 1 ? StereoLayout::SideBySide : StereoLayout::Mono;
  stereoChanged();
}

void Picture::nextLayout() noexcept {
  if (isBound()) return;
  do {
    stereo_.layout = static_cast<StereoLayout>((static_cast<int>(stereo_.layout) + 1) % kStereoLayouts);
  } while (refusal(stereo_, width_, height_) != nullptr ||  // mono is never refused
           (stereo_.layout == StereoLayout::Quilt && !lenticular_));
  stereoChanged();
}

void Picture::setLayout(std::string_view word) noexcept {
  if (isBound() || !parseStereo(word, stereo_)) return;
  lenticular_ = lenticular_ || stereo_.layout == StereoLayout::Quilt;
  stereoChanged();
}

void Picture::swapEyes() noexcept {
  stereo_.swap_eyes = !stereo_.swap_eyes;
  stereoChanged();
}

void Picture::changeStrength(double by) noexcept {
  stereo_.strength = std::clamp(stereo_.strength + by, 0.0, StereoSettings::kMostStrength);
  stereoChanged();
}

void Picture::changeScreenPlane(double by_mm) noexcept {
  stereo_.screen_z_mm = std::clamp(stereo_.screen_z_mm + by_mm, 0.0, volume_.depth_mm);
  stereoChanged();
}

void Picture::changeZoom(double by) noexcept {
  stereo_.zoom = std::clamp(stereo_.zoom + by, 1.0, kMostZoom);
  stereoChanged();
}

void Picture::setAspect(double aspect) noexcept {
  stereo_.stretch = aspect > 0 ? aspect * volume_.height_mm / volume_.width_mm : 1.0;
  stereoChanged();
}

std::optional<Picture::ViewPoint> Picture::viewPoint(double across, double down) const {
  if (width_ <= 0 || height_ <= 0) return std::nullopt;
  const double x = across * width_, y = down * height_;
  const EyeViews eyes = eyeViews(stereo_, volume_, width_, height_);
  for (const EyeView& view : eyes.views) {
    const double right = (x - view.area.x) / view.area.width;
    const double below = (y - (height_ - view.area.y - view.area.height)) / view.area.height;
    if (right >= 0 && right < 1 && below >= 0 && below < 1) return ViewPoint{right, below, eyes.aspect};
  }
  return std::nullopt;
}

TextFrame Picture::textFrame() const {
  if (width_ <= 0 || height_ <= 0) return {};
  const EyeViews eyes = eyeViews(stereo_, volume_, width_, height_);
  const PixelArea& area = eyes.views[0].area;
  return {area.width, area.height, eyes.aspect, eyes.margin_x, eyes.margin_y};
}

void Picture::stereoChanged() noexcept {
  if (renderer_ != nullptr) renderer_->setStereo(stereo_);
}

}  // namespace relievo
