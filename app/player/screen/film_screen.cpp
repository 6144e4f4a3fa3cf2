// SPDX-License-Identifier: Apache-2.0
// Decides when to draw.
#include "app/player/screen/film_screen.h"

#include <glm/geometric.hpp>

#include "app/player/screen/stereo_word.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kDrawShare = 0.6;  // of the film's frame period; the rest is left for decoding and touch
constexpr Duration kRedrawPeriod = std::chrono::milliseconds(33);  // of a paused picture while the finger moves
constexpr double kMovedMm = 0.2;                                   // smaller movements are invisible

bool movedVisibly(const std::optional<FingerMark>& a, const std::optional<FingerMark>& b) {
  if (a.has_value() != b.has_value()) return true;
  return a && (a->contact != b->contact || glm::distance(a->position_mm, b->position_mm) > kMovedMm);
}

}  // namespace

Result<void> FilmScreen::open() {
  auto opened = picture_.open();
  if (opened || opened.error().code != ErrorCode::NotFound) return opened;
  journal_.note(std::string("display: ") + opened.error().message, "film and touch go on without it");
  return {};
}

Result<void> FilmScreen::attend(MonotonicTime now) {
  const auto redraw = picture_.attend(now);
  if (redraw) {
    redraw_ = redraw_ || *redraw;
    return {};
  }
  if (redraw.error().code != ErrorCode::Lost) return std::unexpected(redraw.error());
  noteLost();
  return {};
}

void FilmScreen::setScene(const DepthCalibration& calibration, const DisplayVolume& volume, Duration period,
                          MonotonicTime now) {
  picture_.setScene(calibration, volume, fromSeconds(kDrawShare * toSeconds(period)));
  text_.wake(now);
}

Result<bool> FilmScreen::show(const FramePair& pair, const std::optional<FingerMark>& finger, MonotonicTime now) {
  picture_.setPair(pair);
  const auto seen = draw(finger, now);
  if (!seen || !*seen) {
    ++dropped_;
    return seen;
  }
  ++shown_;
  if (!first_shown_) first_shown_ = clock_.now();
  return true;
}

Result<void> FilmScreen::redraw(const std::optional<FingerMark>& finger, MonotonicTime next_picture,
                                MonotonicTime now) {
  if (!redraw_) {
    if (now < drawn_at_ + kRedrawPeriod || next_picture < now + kRedrawPeriod) return {};
    if (!picture_.away() && !movedVisibly(finger, drawn_finger_)) return {};
  }
  const auto drawn = draw(finger, now);
  return drawn ? Result<void>{} : std::unexpected(drawn.error());
}

Result<void> FilmScreen::clear(const std::optional<FingerMark>& finger, MonotonicTime now) {
  picture_.clear();
  const auto drawn = draw(finger, now);
  return drawn ? Result<void>{} : std::unexpected(drawn.error());
}

// False if the screen is lost.
Result<bool> FilmScreen::draw(const std::optional<FingerMark>& finger, MonotonicTime now) {
  drawn_finger_ = finger;
  drawn_at_ = now;
  redraw_ = false;
  const auto shown = picture_.show(finger, now);
  if (!shown) return std::unexpected(shown.error());
  if (const char* why = picture_.takeRefusal()) {
    journal_.note(std::string("stereo: ") + why, print("shown as %s", name(picture_.stereo().layout)));
  }
  if (*shown == Picture::Shown::Lost) noteLost();
  if (*shown == Picture::Shown::Back) journal_.note("display back", "the picture is shown again");
  return *shown == Picture::Shown::OnScreen || *shown == Picture::Shown::Back;
}

void FilmScreen::write(const ScreenFacts& facts, MonotonicTime next_picture, MonotonicTime now) {
  if (!first_shown_) return;
  auto lines = text_.lines(facts, now);
  if (lines == written_) return;
  written_ = lines;
  picture_.setText(std::move(lines));
  if (next_picture > now + 2 * kRedrawPeriod) redraw_ = true;  // else the next picture shows it
}

void FilmScreen::obey(const PlayerCommand& command) {
  switch (command.verb) {
    case PlayerVerb::Info:
      return text_.toggle();
    case PlayerVerb::FullScreen:
      return picture_.fillScreen(command.value == 0  ? FullScreen::Toggle
                                 : command.value > 0 ? FullScreen::On
                                                     : FullScreen::Off);
    case PlayerVerb::Layout:
      if (command.word.empty()) picture_.nextLayout();
      else picture_.setLayout(command.word);
      break;
    case PlayerVerb::SwapEyes:
      picture_.swapEyes();
      break;
    case PlayerVerb::DepthBy:
      picture_.changeStrength(command.value);
      break;
    case PlayerVerb::ScreenBy:  // parts above the screen plane appear in front of the screen
      picture_.changeScreenPlane(-command.value);
      break;
    default:
      return;
  }
  redraw_ = true;
}

void FilmScreen::describe(PlayReport& report) const {
  const RenderStatistics& drawn = picture_.statistics();
  report.display = picture_.capabilities().name;
  report.stereo = stereoWord(picture_.stereo());
  report.surface_width = picture_.width();
  report.surface_height = picture_.height();
  report.imported = drawn.imported;
  report.triangles = drawn.triangles;
  report.picture_error_px = drawn.error_px;
  report.mesh_ms = drawn.mesh_ms;
  report.draw_ms = drawn.frame_ms;
  report.frames_shown = shown_;
  report.frames_dropped = dropped_;
}

void FilmScreen::noteLost() {
  journal_.note("display lost", "film and touch continue; the display is tried again every second");
}

}  // namespace relievo
