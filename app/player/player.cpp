// SPDX-License-Identifier: Apache-2.0
// The player's life: boot, the loop, the end.
#include "app/player/player.h"

#include <algorithm>
#include <utility>

#include "app/player/control/player_control.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr Duration kLongestWait = std::chrono::milliseconds(5);  // the most that a key waits
constexpr Duration kIdleWait = std::chrono::milliseconds(20);    // without a film
constexpr Duration kReaderWait = std::chrono::milliseconds(2);   // while the picture waits for the reader or a camera

PairReader::Backends backendsOf(const PlayerParts& parts, bool own_threads) {
  PairReader::Backends backends = parts.backends;
  backends.clock = &parts.clock;
  backends.own_threads = own_threads;
  return backends;
}

}  // namespace

Player::Player(PlayerConfig config, PlayerParts parts)
    : config_(std::move(config)),
      parts_(std::move(parts)),
      journal_(parts_.clock,
               [this](const FaultEntry& fault, MonotonicTime when, bool fresh) {
                 if (parts_.control != nullptr) parts_.control->happened(fault);
                 if (fresh) screen_.text().tell(fault.sentence(), when);
               }),
      files_(config_.own_threads ? FileWriter::Where::OwnThread : FileWriter::Where::AtOnce),
      programme_(config_.resume_path, files_, config_.loop),
      film_(backendsOf(parts_, config_.own_threads), parts_.audio, parts_.clock, journal_),
      touch_({parts_.haptic, parts_.recorder}, parts_.second_finger, parts_.clock,
             config_.own_threads ? Ticking::Thread : Ticking::ByHand, journal_),
      screen_(parts_.display, config_.display, config_.stereo, config_.osd, parts_.clock, journal_, files_),
      keys_(config_.keys),
      loudness_(config_.volume_path, config_.sound_device) {
  if (config_.volume_percent) loudness_.set(*config_.volume_percent);
  film_.soundOutput().setGain(loudness_.gain());
  if (config_.browser) browser_.emplace(*config_.browser, parts_.posters, config_.source, config_.own_threads);
  parts_.display.hearMouse([this](const SurfaceMouse& mouse) { return hearMouse(mouse); });
  nameKeys();
  journal_.stateChanged(state_);
  film_.hearLive([this](const FramePair& pair) { touch_.hear(pair.depth, pair.material); });
}

Player::~Player() {
  film_.stop();  // its reader may be about to call `hear`
  touch_.stop();
  parts_.display.hearMouse({});
}

bool Player::apply(PlayerEvent event) {
  const auto next = nextState(state_, event);
  if (!next) return false;
  if (std::exchange(state_, *next) == *next) return true;
  journal_.stateChanged(state_);
  if (parts_.control != nullptr) parts_.control->stateChanged(state_, journal_.sinceBegin(parts_.clock.now()));
  return true;
}

void Player::failFilm(const std::string& thing, const Error& error) {
  if (!apply(PlayerEvent::Fail)) return;
  film_.countPlayed(parts_.clock.now());
  journal_.noteStop(thing + ": " + error.message);
  failure_ = Failure{thing, error};
}

void Player::failDisplay(const Error& error) {
  display_failed_ = true;
  failFilm(std::string("display ") + screen_.capabilities().name, error);
}

// A picture that cannot be drawn (Unsupported) is the film's fault, other errors are the display's.
void Player::failDrawing(const Error& error) {
  if (error.code == ErrorCode::Unsupported) failFilm(programme_.film().url, error);
  else failDisplay(error);
}

Outcome<void> Player::run(const std::atomic<bool>& stop) {
  journal_.begin();
  boot(stop);
  while (alive()) {
    const MonotonicTime now = parts_.clock.now();
    const bool time_is_up = config_.duration && now - journal_.began() >= *config_.duration;
    if (time_is_up || stop.load(std::memory_order_relaxed)) break;
    step(now);
    if (alive()) touch_.sleepUntil(nextWake(parts_.clock.now()));
  }
  finish(parts_.clock.now());
  if (missed_) return std::unexpected(*missed_);
  if (failure_) return std::unexpected(*failure_);
  return {};
}

bool Player::alive() const noexcept {
  if (quitting_ || state_ == PlayerState::Fault) return false;
  return state_ != PlayerState::Idle || config_.stays;
}

void Player::boot(const std::atomic<bool>& stop) {
  if (auto opened = screen_.open(stop); !opened) return failDisplay(opened.error());
  if (config_.full_screen) screen_.obey({PlayerVerb::FullScreen, 1});
  if (parts_.remote != nullptr) {
    if (auto heard = parts_.remote->open(); !heard) {
      journal_.note(std::string("remote: ") + heard.error().message, "the film plays without one");
      parts_.remote = nullptr;
    }
  }
  film_.begin();
  touch_.begin();
  apply(PlayerEvent::Ready);
  if (parts_.control != nullptr) parts_.control->ready();
  if (config_.source.url.empty() || config_.fault) {
    openBrowser(journal_.began());
    if (!config_.fault) return;
    const auto& [thing, error] = *config_.fault;
    log(LogLevel::Error, thing.c_str(), "%s", error.message);
    return screen_.text().tell(thing + ": " + error.message, journal_.began());
  }
  std::vector<PlaylistEntry> films{{.url = config_.source.url, .depth_url = config_.source.depth_url, .title = ""}};
  for (const std::string& url : config_.more) films.push_back({.url = url, .depth_url = "", .title = ""});
  openList(films, journal_.began());
}

void Player::step(MonotonicTime now) {
  film_.read();
  if (const auto attended = screen_.attend(now); !attended) {
    if (attended.error().code == ErrorCode::Cancelled) quitting_ = true;  // the viewer has closed the window
    else failDisplay(attended.error());
  }
  followDrops(now);
  followMouse(now);
  readRemote(now);
  followDevice();
  film_.noteNews();
  followReader(now);
  tellDoubts(now);
  followClock(now);
  followLoopAB(now);
  while (auto subtitle = film_.takeSubtitle()) screen_.subtitles().add(std::move(*subtitle));
  film_.followSound(state_ == PlayerState::Playing);
  programme_.keep(film_.placeToKeep(now), now);
  touch_.drain(seeks_, state_ == PlayerState::Playing ? film_.liveTimes() : nullptr);
  followStatistics(now);
  screen_.write(facts(), film_.nextPicture(now), now);
  followBrowser(now);
  followFault(now);
  tellStatus(now);
  if (parts_.control != nullptr) parts_.control->attend(*this, now);  // what a program asks for shows nothing itself
}

// The time of the next picture, but soon enough to answer keys.
MonotonicTime Player::nextWake(MonotonicTime now) const {
  if (state_ == PlayerState::Idle || state_ == PlayerState::Browsing) return now + kIdleWait;
  if (state_ == PlayerState::Playing)
    return std::min(film_.nextPicture(now), now + (film_.isLive() ? kReaderWait : kLongestWait));
  return now + (state_ == PlayerState::Paused ? kLongestWait : kReaderWait);
}

void Player::finish(MonotonicTime now) {
  touch_.stop();  // zero force before anything else
  film_.silence();
  loudness_.keep(files_);
  if (parts_.status != nullptr) parts_.status->clear();
  if (parts_.control != nullptr) parts_.control->stopping();
  touch_.drain(seeks_, nullptr);
  leaveFilm(now);
  if (state_ != PlayerState::Fault) apply(PlayerEvent::Stop);
  ended_ = parts_.clock.now();
  film_.stop();
  screen_.close();
  if (parts_.remote != nullptr) parts_.remote->close();
  files_.finish();
}

}  // namespace relievo
