// SPDX-License-Identifier: Apache-2.0
// What the player does with the film: waits for the reader, follows the clock, and feeds the eye and the finger.
#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <utility>

#include "app/player/player.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Duration kUnknownPeriod = std::chrono::milliseconds(40);
constexpr Duration kSoundFirst = std::chrono::milliseconds(300);  // that has to be there when the film begins
constexpr double kDrawShare = 0.6;  // of the film's frame period; the rest is the decoder's and the finger's
constexpr Duration kRedrawPeriod = std::chrono::milliseconds(33);  // of a standing picture in which the finger moves
constexpr double kMovedMm = 0.2;                                   // less is not seen

const char* answerTo(HapticFault::Kind kind) noexcept {
  switch (kind) {
    case HapticFault::Kind::DeviceLost:
      return "force zero; the film plays on, and the device is looked for";
    case HapticFault::Kind::DeviceError:
      return "the tick was left out";
    case HapticFault::Kind::FeedStale:
      return "force faded";
    case HapticFault::Kind::FeedRecovered:
      return "force faded in again";
  }
  return "";
}

// The last part of a path or an address, without what follows a question mark.
std::string titleOf(const std::string& url) {
  const std::string path = url.substr(0, url.find('?'));
  const std::size_t end = path.find_last_not_of('/');
  if (end == std::string::npos) return url;
  const std::size_t slash = path.rfind('/', end);
  return path.substr(slash == std::string::npos ? 0 : slash + 1,
                     end - (slash == std::string::npos ? 0 : slash + 1) + 1);
}

bool movedVisibly(const std::optional<FingerMark>& a, const std::optional<FingerMark>& b) {
  if (a.has_value() != b.has_value()) return true;
  return a && (a->contact != b->contact || glm::distance(a->position_mm, b->position_mm) > kMovedMm);
}

}  // namespace

void Player::followReader(MonotonicTime now) {
  if (state_ == PlayerState::Opening) {
    const FilmFeed::State state = feed_.state();
    if (state == FilmFeed::State::Failed) return fail(feed_.failedThing(), feed_.error());
    if (state == FilmFeed::State::Opening) return;
    if (state == FilmFeed::State::Listed) return followList(now);
    opened(now);
  }
  if (state_ == PlayerState::Seeking) {
    if (feed_.state() == FilmFeed::State::Seeking) return;
    if (const auto refused = feed_.takeSeekError()) {
      note(std::string("seek: ") + refused->message, "the film goes on from where it stands");
      static_cast<void>(clock_.setRate(rate_ = 1, now));
    }
    apply(PlayerEvent::Sought);
  }
  if (state_ != PlayerState::Buffering) return;
  head_.refill(feed_);
  if (head_.filled() || (head_.last() && !head_.ahead().empty())) {
    const MediaTime heard_until = head_.ahead().front().color.pts + kSoundFirst;
    if (rate_ == 1 && !feed_.hasSoundUntil(heard_until)) return;
    return begin(now);
  }
  if (!head_.last()) return;
  if (feed_.state() == FilmFeed::State::Failed) return fail(feed_.failedThing(), feed_.error());
  endOfFilm(now);
}

void Player::opened(MonotonicTime now) {
  apply(PlayerEvent::Opened);
  failure_.reset();  // of a film before
  backwards_ = false;
  report_.film = feed_.info();
  period_ = report_.film.frame_period > Duration(0) ? report_.film.frame_period : kUnknownPeriod;
  for (const std::string& line : report_.film.reading) log(LogLevel::Info, "play", "%s", line.c_str());
  for (const std::string& doubt : report_.film.doubts) log(LogLevel::Warning, "play", "%s", doubt.c_str());
  if (report_.film.has_depth) {
    log(LogLevel::Info, "play", "depth: %s", report_.film.calibration.explanation.c_str());
  } else {
    note("no depth in this film", "it plays flat, without force");
  }
  if (const char* refused = report_.film.sound_refused)
    note(std::string("sound: ") + refused, "the film plays without");
  goOnWhereLeft(now);
}

// The first pair after a start, a seek or an underrun is on the screen before its clock starts: whatever the first
// drawing takes, nothing is late by it.
void Player::begin(MonotonicTime now) {
  head_.begin();
  if (!std::exchange(scene_known_, true)) {
    setScene();
    text_.wake(now);
  }
  if (std::exchange(new_epoch_, false)) surface_.beginEpoch();
  const MediaTime first = head_.present().color.pts;
  showPresent(now);
  if (state_ == PlayerState::Fault) return;
  if (haptic_.waiting()) {
    feedSurface({first, parts_.clock.now(), 0});  // at a stand, so that the force fades in on something that is there
    startTouch();
  }

  now = parts_.clock.now();
  clock_.reset();
  clock_.start(first, now);
  if (held_) setClockHeld(true, now);
  apply(held_ ? PlayerEvent::FilledHeld : PlayerEvent::Filled);
  if (!held_) segment_begin_ = first;
  followSurface();
  if (target_ && seek_wanted_) {
    report_.seeks.back().picture_s = toSeconds(first);
    report_.seeks.back().picture_ms = 1e3 * toSeconds(now - sought_);
    await_touch_ = parts_.clock.now();
  }
  target_.reset();
}

void Player::setScene() {
  const Frame& shape = head_.present().depth.empty() ? head_.present().color : head_.present().depth;
  volume_ = config_.volume.value_or(DisplayVolume::forPicture(shape.width, shape.height, shape.sample_aspect));
  const DepthCalibration& calibration = report_.film.calibration.calibration;
  surface_.setScene(calibration, volume_);
  picture_.setScene(calibration, volume_, fromSeconds(kDrawShare * toSeconds(period_)));
}

// A device may come, or come back, at any time.
void Player::followDevice() {
  using Kind = DeviceKeeper::News::Kind;
  while (const auto news = haptic_.poll()) {
    if (news->kind == Kind::Refused) {
      note(std::string("haptic device: ") + news->error.message, "the film plays without force; it is looked for anew");
    } else if (news->kind == Kind::Homing) {
      note("haptic device: it does not know its zero; move the handle through its whole range", "no force until then");
    } else if (haptic_lost_) {
      note("haptic device back", "the force fades in");
    }
  }
  const bool shown = state_ == PlayerState::Playing || state_ == PlayerState::Paused;
  if (!haptic_.waiting() || !shown) return;
  followSurface();
  startTouch();
}

void Player::startTouch() {
  if (auto started = haptic_.start(volume_, surface_); !started) {
    note(std::string("haptic device: ") + started.error().message, "the film plays without force");
    return;
  }
  if (parts_.recorder != nullptr) parts_.recorder->setDevice(haptic_.capabilities());
  // The real-time thread says so itself: here it is for the report.
  const double time_s = toSeconds(parts_.clock.now() - started_);
  for (const char* missing : {haptic_.missingMemory(), haptic_.missingScheduler()}) {
    if (missing != nullptr) report_.addFault(time_s, std::string("haptic: ") + missing, "ticks may come late");
  }
}

void Player::followClock(MonotonicTime now) {
  if (state_ != PlayerState::Playing && state_ != PlayerState::Paused) return;
  const MediaTime position = clock_.position(now).value_or(MediaTime{});  // these two states have a clock
  const std::size_t steps = head_.advance(position, feed_);
  followSurface();
  if (steps > 0) {
    report_.frames_dropped += steps - 1;
    showPresent(now);
  } else {
    redrawFinger(now);
  }
  if (state_ == PlayerState::Playing) followEnd(position, now);
}

void Player::followSound() {
  sound_.follow(state_ == PlayerState::Playing && rate_ == 1, clock_, feed_);
  if (const auto news = sound_.takeNews()) note(news->what, news->done);
}

// What there is to do when nothing lies ahead.
void Player::followEnd(MediaTime position, MonotonicTime now) {
  if (!head_.ahead().empty()) {
    dry_since_.reset();
    return;
  }
  if (head_.last()) {
    if (position < head_.present().color.pts + period_) return;
    if (feed_.state() == FilmFeed::State::Failed) return fail(feed_.failedThing(), feed_.error());
    return endOfFilm(now);
  }
  // A pair that is late by less than a period is shown late; after that the film waits for the reader. Counted from
  // here, not from the picture: the reader is not to blame for a picture that took long to draw.
  if (!dry_since_) dry_since_ = now;
  if (now < *dry_since_ + 2 * period_) return;
  dry_since_.reset();
  closeSegment(now);
  apply(PlayerEvent::Starved);
  note("the film came too slowly, or this machine is too slow for it",
       "the picture stands until it is read ahead again");
}

void Player::closeSegment(MonotonicTime now) {
  if (const auto position = clock_.position(now); position && segment_begin_) {
    played_ += std::min(*position, head_.present().color.pts + period_) - *segment_begin_;
  }
  segment_begin_.reset();
}

void Player::followSurface() {
  if (const auto sample = clock_.sample()) feedSurface(*sample);
}

void Player::feedSurface(const ClockSample& clock) {
  static_assert(Playhead::kAhead == SurfaceWindow::kAhead);
  const Frame present = rate_ > 1 ? Frame{} : head_.present().depth;  // of a film that rushes by nothing is felt
  std::array<Frame, Playhead::kAhead> ahead;
  const std::size_t count = std::min(head_.ahead().size(), ahead.size());
  for (std::size_t i = 0; i < count; ++i) ahead[i] = head_.ahead()[i].depth;
  const bool last = head_.last() && count == head_.ahead().size();
  const auto changed = surface_.update(present, std::span(ahead).first(count), last, clock);
  if (!changed) {
    if (!std::exchange(depth_refused_, true)) {
      note(std::string("depth: ") + changed.error().message, "it plays without force");
    }
    haptic_.publish(surface_);
    return;
  }
  if (*changed) haptic_.publish(surface_);
  const bool missing = rate_ <= 1 && report_.film.has_depth && present.empty();
  if (missing && !depth_missing_) note("no depth at this time", "the picture is flat there, without force");
  depth_missing_ = missing;
}

void Player::showPresent(MonotonicTime now) {
  picture_.setPair(head_.present());
  if (!draw(now)) {
    ++report_.frames_dropped;
    return;
  }
  ++report_.frames_shown;
  sound_.noteShown(head_.present().color.pts, clock_);
  noteLatency();
  if (!report_.first_frame_ms) report_.first_frame_ms = 1e3 * toSeconds(parts_.clock.now() - started_);
}

// What is felt is the surface at the clock's time, between this picture and the next.
void Player::noteLatency() {
  const FramePair& shown = head_.present();
  if (!shown.taken) return;
  const MonotonicTime now = parts_.clock.now();
  const MediaTime felt = clock_.position(now).value_or(shown.color.pts);
  picture_latency_.add(now - *shown.taken);
  touch_latency_.add(now - (*shown.taken + (felt - shown.color.pts)));
}

// Between two pictures of the film the finger moves; it is drawn where there is time for it.
void Player::redrawFinger(MonotonicTime now) {
  if (!redraw_) {
    if (now < last_draw_ + kRedrawPeriod || nextPicture(now) < now + kRedrawPeriod) return;
    if (!picture_.away() && !movedVisibly(fingerMark(), last_mark_)) return;
  }
  static_cast<void>(draw(now));
}

// False when nobody sees it.
bool Player::draw(MonotonicTime now) {
  last_mark_ = fingerMark();
  last_draw_ = now;
  redraw_ = false;
  const auto shown = picture_.show(last_mark_, now);
  if (!shown) {
    // What cannot be drawn is the film's fault, not the display's.
    if (shown.error().code == ErrorCode::Unsupported) fail(film().url, shown.error());
    else failDisplay(shown.error());
    return false;
  }
  if (const char* why = picture_.takeRefusal()) {
    note(std::string("stereo: ") + why, print("shown as %s", name(picture_.stereo().layout)));
  }
  if (*shown == Picture::Shown::Lost) noteLost();
  if (*shown == Picture::Shown::Back) note("display back", "the picture is on it again");
  return *shown == Picture::Shown::OnScreen || *shown == Picture::Shown::Back;
}

ScreenFacts Player::facts() const {
  const bool shown = report_.first_frame_ms.has_value();
  const auto position = place(parts_.clock.now()).value_or(shown ? head_.present().color.pts : MediaTime{});
  return {.title = film().title.empty() ? titleOf(film().url) : film().title,
          .position_s = toSeconds(position),
          .duration_s = toSeconds(report_.film.duration),
          .state = state_,
          .held = held_,
          .rate = rate_,
          .loop = config_.loop,
          .film = film_ + 1,
          .films = films_.size(),
          .stereo = picture_.stereo(),
          .has_depth = report_.film.has_depth,
          .haptic = haptic_.running() ? haptic_.capabilities().name : "",
          .contact = last_mark_ && last_mark_->contact};
}

void Player::writeText(MonotonicTime now) {
  if (!report_.first_frame_ms) return;
  auto lines = text_.lines(facts(), now);
  if (lines == last_text_) return;
  last_text_ = lines;
  picture_.setText(std::move(lines));
  if (nextPicture(now) > now + 2 * kRedrawPeriod) redraw_ = true;  // else the next picture bears it
}

void Player::noteLost() {
  note("display lost", "film and touch go on; it is tried again every second");
}

std::optional<FingerMark> Player::fingerMark() {
  const FingerState* finger = haptic_.finger();
  if (finger == nullptr) return std::nullopt;
  return FingerMark{finger->proxy_mm, finger->force_n, finger->contact};
}

// When the next picture is due: never, while the film stands.
MonotonicTime Player::nextPicture(MonotonicTime now) const {
  const auto sample = clock_.sample();
  if (!sample || sample->rate <= 0) return MonotonicTime::max();
  if (head_.ahead().empty()) return now + period_;
  return sample->when(head_.ahead().front().color.pts);
}

void Player::drainTouch() {
  while (const auto tick = haptic_.nextTick()) {
    if (parts_.recorder != nullptr) parts_.recorder->add(*tick);
    if (!report_.first_touch_ms && tick->device_present) {
      report_.first_touch_ms = 1e3 * toSeconds(tick->time - started_);
    }
    if (!await_touch_ || tick->time <= *await_touch_) continue;
    if (const auto frame = surface_.frameAt(tick->media_time)) report_.seeks.back().surface_s = toSeconds(*frame);
    report_.seeks.back().surface_ms = 1e3 * toSeconds(tick->time - sought_);
    await_touch_.reset();
  }
  haptic_.printLog();
  while (const auto fault = haptic_.nextFault()) {
    haptic_lost_ = haptic_lost_ || fault->kind == HapticFault::Kind::DeviceLost;
    note(name(fault->kind), answerTo(fault->kind), fault->time);
  }
}

}  // namespace relievo
