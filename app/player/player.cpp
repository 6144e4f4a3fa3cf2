// SPDX-License-Identifier: Apache-2.0
// The player's life: boot, the loop, the remote's wishes, the end. What follows the film is in player_film.cpp.
#include "app/player/player.h"

#include <algorithm>
#include <utility>

#include "app/player/stereo_word.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr std::size_t kQueuedPairs = 4;                          // beyond those that the playhead holds
constexpr Duration kLongestWait = std::chrono::milliseconds(5);  // a key is heard after this at most
constexpr Duration kReaderWait = std::chrono::milliseconds(2);   // while the picture waits for the reader
constexpr std::size_t kMostStates = 10'000;                      // of a film that loops for months

}  // namespace

Player::Player(PlayerConfig config, PlayerParts parts)
    : config_(std::move(config)),
      parts_(std::move(parts)),
      feed_(parts_.backends, kQueuedPairs),
      picture_(parts_.display, config_.display, config_.stereo),
      haptic_(parts_.haptic, parts_.clock, config_.own_threads ? Ticking::Thread : Ticking::ByHand) {
  report_.states.push_back(state_);
}

Player::~Player() {
  haptic_.stop();
}

bool Player::apply(PlayerEvent event) {
  const auto next = nextState(state_, event);
  if (!next) return false;
  if (*next != state_ && report_.states.size() < kMostStates) report_.states.push_back(*next);
  state_ = *next;
  return true;
}

void Player::note(const std::string& what, const std::string& done, std::optional<MonotonicTime> when) {
  const MonotonicTime time = when.value_or(parts_.clock.now());
  if (report_.addFault(toSeconds(time - started_), what, done)) {
    log(LogLevel::Warning, "play", "%s; %s", what.c_str(), done.c_str());
    text_.tell(what, time);
  }
}

void Player::fail(std::string thing, const Error& error) {
  if (!apply(PlayerEvent::Fail)) return;
  closeSegment(parts_.clock.now());
  report_.addFault(toSeconds(parts_.clock.now() - started_), thing + ": " + error.message, "stopped");
  failure_ = Failure{std::move(thing), error};
}

Outcome<void> Player::run(const std::atomic<bool>& stop) {
  started_ = parts_.clock.now();
  boot();
  while (alive()) {
    const MonotonicTime now = parts_.clock.now();
    const bool time_is_up = config_.duration && now - started_ >= *config_.duration;
    if (time_is_up || stop.load(std::memory_order_relaxed)) {
      end(now);
      break;
    }
    step(now);
    if (alive()) haptic_.sleepUntil(nextWake(parts_.clock.now()));
  }
  finish();
  if (failure_) return std::unexpected(*failure_);
  return {};
}

bool Player::alive() const noexcept {
  return state_ != PlayerState::Idle && state_ != PlayerState::Fault;
}

void Player::end(MonotonicTime now) {
  closeSegment(now);
  apply(PlayerEvent::Stop);
}

void Player::boot() {
  auto opened = picture_.open();
  if (!opened && opened.error().code == ErrorCode::NotFound) {
    note(std::string("display: ") + opened.error().message, "film and touch go on without it");
  } else if (!opened) {
    fail(std::string("display ") + picture_.capabilities().name, opened.error());
    return;
  }
  if (parts_.remote != nullptr) {
    if (auto heard = parts_.remote->open(); !heard) {
      note(std::string("remote: ") + heard.error().message, "the film plays without one");
      parts_.remote = nullptr;
    }
  }
  haptic_.begin();
  apply(PlayerEvent::Ready);
  apply(PlayerEvent::Open);
  feed_.open(config_.source);
  if (config_.own_threads) feed_.startThread();
}

void Player::step(MonotonicTime now) {
  if (!config_.own_threads) {
    while (feed_.work()) {
    }
  }
  attendScreen(now);
  readRemote(now);
  followDevice();
  followReader(now);
  followClock(now);
  drainTouch();
  writeText(now);
}

// Until the next picture, but so often that keys are heard.
MonotonicTime Player::nextWake(MonotonicTime now) const {
  if (state_ == PlayerState::Playing) return std::min(nextPicture(now), now + kLongestWait);
  return now + (state_ == PlayerState::Paused ? kLongestWait : kReaderWait);
}

void Player::finish() {
  haptic_.stop();  // zero force before anything else
  drainTouch();
  const MonotonicTime ended = parts_.clock.now();
  report_.wall_s = toSeconds(ended - started_);
  report_.pairs = feed_.counters();
  feed_.stop();
  picture_.close();
  if (parts_.remote != nullptr) parts_.remote->close();
}

PlayReport Player::report() const {
  PlayReport report = report_;
  report.source = config_.source.url;
  report.depth_source = config_.source.depth_url;
  report.volume = volume_;
  report.media_s = toSeconds(played_);
  report.display = picture_.capabilities().name;
  report.stereo = stereoWord(picture_.stereo());
  report.surface_width = picture_.width();
  report.surface_height = picture_.height();
  report.imported = picture_.statistics().imported;
  report.triangles = picture_.statistics().triangles;
  report.picture_error_px = picture_.statistics().error_px;
  report.mesh_ms = picture_.statistics().mesh_ms;
  report.draw_ms = picture_.statistics().frame_ms;
  report.haptic = haptic_.summary();
  return report;
}

void Player::attendScreen(MonotonicTime now) {
  const auto redraw = picture_.attend(now);
  if (redraw) {
    redraw_ = redraw_ || *redraw;
  } else if (redraw.error().code == ErrorCode::Cancelled) {
    end(now);
  } else if (redraw.error().code == ErrorCode::Lost) {
    noteLost();
  } else {
    fail(std::string("display ") + picture_.capabilities().name, redraw.error());
  }
}

void Player::readRemote(MonotonicTime now) {
  while (parts_.remote != nullptr) {
    const auto key = parts_.remote->poll(now);
    if (!key) {
      note(std::string("remote: ") + key.error().message, "the film goes on without one");
      parts_.remote->close();
      parts_.remote = nullptr;
      return;
    }
    if (!*key) return;
    if (const auto command = commandOf(**key)) obey(*command, now);
  }
}

void Player::obey(PlayerCommand command, MonotonicTime now) {
  text_.wake(now);
  switch (command) {
    case PlayerCommand::Play:
      return setHeld(false, now);
    case PlayerCommand::Pause:
      return setHeld(true, now);
    case PlayerCommand::PlayPause:
      return setHeld(!held_, now);
    case PlayerCommand::SeekForward:
      return seek(seekBase(now) + kSeekStep, PlayerEvent::Seek, now);
    case PlayerCommand::SeekBackward:
      return seek(seekBase(now) - kSeekStep, PlayerEvent::Seek, now);
    case PlayerCommand::NextLayout:
    case PlayerCommand::SwapEyes:
    case PlayerCommand::DeeperPicture:
    case PlayerCommand::FlatterPicture:
    case PlayerCommand::ScreenForward:
    case PlayerCommand::ScreenBackward:
      return changeStereo(command);
    case PlayerCommand::Info:
      return text_.toggle();
    case PlayerCommand::Stop:
      return end(now);
  }
}

void Player::changeStereo(PlayerCommand command) {
  constexpr double kStrengthStep = 0.1, kPlaneStepMm = 2.0;
  if (command == PlayerCommand::NextLayout) picture_.nextLayout();
  if (command == PlayerCommand::SwapEyes) picture_.swapEyes();
  if (command == PlayerCommand::DeeperPicture) picture_.changeStrength(kStrengthStep);
  if (command == PlayerCommand::FlatterPicture) picture_.changeStrength(-kStrengthStep);
  // What is higher in the volume than the plane stands before the screen.
  if (command == PlayerCommand::ScreenForward) picture_.changeScreenPlane(-kPlaneStepMm);
  if (command == PlayerCommand::ScreenBackward) picture_.changeScreenPlane(kPlaneStepMm);
  redraw_ = true;
}

void Player::setHeld(bool held, MonotonicTime now) {
  const PlayerState before = state_;
  if (!apply(held ? PlayerEvent::Pause : PlayerEvent::Play)) return;
  held_ = held;
  if (state_ == before) return;  // heard while buffering or seeking: it holds from the next picture on
  if (held) closeSegment(now);
  setClockHeld(held, now);
  if (!held) segment_begin_ = clock_.position(now);
}

void Player::setClockHeld(bool held, MonotonicTime now) {
  if (auto set = held ? clock_.pause(now) : clock_.resume(now); !set) fail("the film's clock", set.error());
}

// Where a step of the remote counts from: several presses add up, whether or not the first has been carried out.
MediaTime Player::seekBase(MonotonicTime now) const {
  if (target_) return *target_;
  if (state_ == PlayerState::Buffering) return head_.present().color.pts;
  return clock_.position(now).value_or(MediaTime{});
}

void Player::seek(MediaTime target, PlayerEvent why, MonotonicTime now) {
  closeSegment(now);
  if (!apply(why)) return;
  // As the picture stands until the new one comes, so does the surface: what is seen is what is felt.
  if (const auto position = clock_.position(now)) feedSurface({*position, now, 0});
  await_touch_.reset();
  clock_.reset();
  head_.clear();
  target_ = std::max(target, MediaTime{});
  feed_.seek(*target_);
  new_epoch_ = true;
  seek_wanted_ = why == PlayerEvent::Seek;
  if (seek_wanted_) report_.seeks.push_back({toSeconds(*target_), {}, {}});
}

}  // namespace relievo
