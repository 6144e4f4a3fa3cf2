// SPDX-License-Identifier: Apache-2.0
// The player's life: boot, the loop, the end.
#include "app/player/player.h"

#include <algorithm>
#include <utility>

#include "app/player/control/player_control.h"
#include "app/player/screen/stereo_word.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr std::size_t kQueuedPairs = 4;                          // beyond those that the playhead holds
constexpr Duration kLongestWait = std::chrono::milliseconds(5);  // a key is heard after this at most
constexpr Duration kIdleWait = std::chrono::milliseconds(20);    // without a film
constexpr Duration kReaderWait = std::chrono::milliseconds(2);   // while the picture waits for the reader
constexpr std::size_t kMostStates = 10'000;                      // of a film that loops for months

PairReader::Backends backendsOf(const PlayerParts& parts, bool own_threads) {
  PairReader::Backends backends = parts.backends;
  backends.clock = &parts.clock;
  backends.own_threads = own_threads;
  return backends;
}

LiveLatency::Times times(const Histogram& histogram) {
  const auto ms = [](Duration d) { return 1e3 * toSeconds(d); };
  return {ms(histogram.quantile(0.5)), ms(histogram.quantile(0.99)), ms(histogram.max())};
}

}  // namespace

Player::Player(PlayerConfig config, PlayerParts parts)
    : config_(std::move(config)),
      parts_(std::move(parts)),
      feed_(backendsOf(parts_, config_.own_threads), kQueuedPairs),
      picture_(parts_.display, config_.display, config_.stereo),
      haptic_(parts_.haptic, parts_.clock, config_.own_threads ? Ticking::Thread : Ticking::ByHand),
      sound_(parts_.audio, parts_.clock),
      keys_(config_.keys) {
  report_.states.push_back(state_);
  if (!config_.resume_path.empty()) resume_.emplace(config_.resume_path);
}

Player::~Player() {
  haptic_.stop();
}

bool Player::apply(PlayerEvent event) {
  const auto next = nextState(state_, event);
  if (!next) return false;
  const bool changed = *next != state_;
  if (changed && report_.states.size() < kMostStates) report_.states.push_back(*next);
  state_ = *next;
  if (changed && parts_.control != nullptr) {
    parts_.control->stateChanged(state_, toSeconds(parts_.clock.now() - started_));
  }
  return true;
}

void Player::note(const std::string& what, const std::string& done, std::optional<MonotonicTime> when) {
  const MonotonicTime time = when.value_or(parts_.clock.now());
  if (parts_.control != nullptr) parts_.control->happened({toSeconds(time - started_), what, done});
  if (report_.addFault(toSeconds(time - started_), what, done)) {
    log(LogLevel::Warning, "play", "%s; %s", what.c_str(), done.c_str());
    text_.tell(what, time);
  }
}

void Player::fail(std::string thing, const Error& error) {
  if (!apply(PlayerEvent::Fail)) return;
  closeSegment(parts_.clock.now());
  const double time_s = toSeconds(parts_.clock.now() - started_);
  report_.addFault(time_s, thing + ": " + error.message, "stopped");
  if (parts_.control != nullptr) parts_.control->happened({time_s, thing + ": " + error.message, "stopped"});
  failure_ = Failure{std::move(thing), error};
}

void Player::failDisplay(const Error& error) {
  hopeless_ = true;
  fail(std::string("display ") + picture_.capabilities().name, error);
}

Outcome<void> Player::run(const std::atomic<bool>& stop) {
  started_ = parts_.clock.now();
  boot();
  while (alive()) {
    const MonotonicTime now = parts_.clock.now();
    const bool time_is_up = config_.duration && now - started_ >= *config_.duration;
    if (time_is_up || stop.load(std::memory_order_relaxed)) break;
    step(now);
    if (alive()) haptic_.sleepUntil(nextWake(parts_.clock.now()));
  }
  finish(parts_.clock.now());
  if (failure_) return std::unexpected(*failure_);
  return {};
}

bool Player::alive() const noexcept {
  if (quitting_ || state_ == PlayerState::Fault) return false;
  return state_ != PlayerState::Idle || config_.stays;
}

void Player::boot() {
  auto opened = picture_.open();
  if (!opened && opened.error().code == ErrorCode::NotFound) {
    note(std::string("display: ") + opened.error().message, "film and touch go on without it");
  } else if (!opened) {
    return failDisplay(opened.error());
  }
  if (parts_.remote != nullptr) {
    if (auto heard = parts_.remote->open(); !heard) {
      note(std::string("remote: ") + heard.error().message, "the film plays without one");
      parts_.remote = nullptr;
    }
  }
  sound_.open();
  config_.source.sound = sound_.format();
  haptic_.begin();
  apply(PlayerEvent::Ready);
  if (parts_.control != nullptr) parts_.control->ready();
  if (config_.own_threads) feed_.startThread();
  if (!config_.source.url.empty()) openList(config_.source.url, config_.source.depth_url, started_);
}

void Player::step(MonotonicTime now) {
  if (!config_.own_threads) {
    while (feed_.work()) {
    }
  }
  attendScreen(now);
  readRemote(now);
  followDevice();
  followSource();
  followReader(now);
  followClock(now);
  followSound();
  keepPosition(now);
  drainTouch();
  writeText(now);
  followFault(now);
  if (parts_.control != nullptr) parts_.control->attend(*this, now);
}

// Until the next picture, but so often that keys are heard.
MonotonicTime Player::nextWake(MonotonicTime now) const {
  if (state_ == PlayerState::Idle) return now + kIdleWait;
  if (state_ == PlayerState::Playing) return std::min(nextPicture(now), now + kLongestWait);
  return now + (state_ == PlayerState::Paused ? kLongestWait : kReaderWait);
}

void Player::finish(MonotonicTime now) {
  haptic_.stop();  // zero force before anything else
  sound_.close();
  if (parts_.control != nullptr) parts_.control->stopping();
  drainTouch();
  leaveFilm(now);
  if (state_ != PlayerState::Fault) apply(PlayerEvent::Stop);
  ended_ = parts_.clock.now();
  feed_.stop();
  picture_.close();
  if (parts_.remote != nullptr) parts_.remote->close();
}

PlayReport Player::report() const {
  PlayReport report = report_;
  report.wall_s = toSeconds(ended_.value_or(parts_.clock.now()) - started_);
  if (film_open_) report.pairs += feed_.counters();
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
  if (picture_latency_.count() > 0) report.live = {times(picture_latency_), times(touch_latency_)};
  report.haptic = haptic_.summary();
  report.sound = sound_.summary();
  return report;
}

void Player::attendScreen(MonotonicTime now) {
  const auto redraw = picture_.attend(now);
  if (redraw) {
    redraw_ = redraw_ || *redraw;
  } else if (redraw.error().code == ErrorCode::Cancelled) {
    quitting_ = true;  // the viewer has closed it
  } else if (redraw.error().code == ErrorCode::Lost) {
    noteLost();
  } else {
    failDisplay(redraw.error());
  }
}

}  // namespace relievo
