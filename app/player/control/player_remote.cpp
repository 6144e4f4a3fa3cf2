// SPDX-License-Identifier: Apache-2.0
// What the viewer asks for: by the remote's keys, or by words from elsewhere.
#include <algorithm>
#include <array>

#include "app/player/player.h"

namespace relievo {
namespace {

constexpr std::array kRates{0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0};
constexpr double kRushStepS = 0.1;  // of the machine's time, between two pictures of a film that rushes by

// The next rate up (1) or down (-1) the ladder.
double rateBeside(double rate, int step) noexcept {
  const auto at = std::ranges::find(kRates, rate) - kRates.begin();
  return kRates[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at + step, 0, kRates.size() - 1))];
}

}  // namespace

void Player::readRemote(MonotonicTime now) {
  while (parts_.remote != nullptr) {
    const auto key = parts_.remote->poll(now);
    if (!key) {
      note(std::string("remote: ") + key.error().message, "the film goes on without one");
      parts_.remote->close();
      parts_.remote = nullptr;
      return;
    }
    if (!*key) break;
    if (const auto command = keys_.take(**key, state_)) obey(*command, now);
  }
  if (const auto command = keys_.held(now)) obey(*command, now);
}

void Player::obey(const PlayerCommand& command, MonotonicTime now) {
  text_.wake(now);
  switch (command.verb) {
    case PlayerVerb::Play:
      return play(now);
    case PlayerVerb::Pause:
      return pause(now);
    case PlayerVerb::PlayPause:
      return held_ || rate_ > 1 || state_ == PlayerState::Idle ? play(now) : pause(now);
    case PlayerVerb::Step:
      return stepPicture(now);
    case PlayerVerb::Faster:
      return changeRate(rateBeside(rate_, 1), now);
    case PlayerVerb::Slower:
      return changeRate(rateBeside(rate_, -1), now);
    case PlayerVerb::SeekBy:
      return seek(seekBase(now) + fromSeconds(command.value), PlayerEvent::Seek, true, now);
    case PlayerVerb::SeekTo:
      return seek(mediaTime(command.value), PlayerEvent::Seek, true, now);
    case PlayerVerb::SeekShare:
      return seekShare(command.value, now);
    case PlayerVerb::Next:
      if (film_ + 1 < films_.size()) openFilm(film_ + 1, now);
      return;
    case PlayerVerb::Previous:
      return previousFilm(now);
    case PlayerVerb::Loop:
      config_.loop = command.value == 0 ? !config_.loop : command.value > 0;
      return;
    case PlayerVerb::Open:
      return openList(command.word, "", now);
    case PlayerVerb::Stop:
      return stopFilm(now);
    case PlayerVerb::Quit:
      quitting_ = true;
      return;
    case PlayerVerb::Layout:
    case PlayerVerb::SwapEyes:
    case PlayerVerb::DepthBy:
    case PlayerVerb::ScreenBy:
      return changeStereo(command);
    case PlayerVerb::Info:
      return text_.toggle();
  }
}

void Player::changeStereo(const PlayerCommand& command) {
  if (command.verb == PlayerVerb::Layout && command.word.empty()) picture_.nextLayout();
  else if (command.verb == PlayerVerb::Layout) picture_.setLayout(command.word);
  if (command.verb == PlayerVerb::SwapEyes) picture_.swapEyes();
  if (command.verb == PlayerVerb::DepthBy) picture_.changeStrength(command.value);
  // What is higher in the volume than the plane stands before the screen.
  if (command.verb == PlayerVerb::ScreenBy) picture_.changeScreenPlane(-command.value);
  redraw_ = true;
}

// While it is opened, read ahead or sought, a wish is heard: it holds from the next picture on.
void Player::play(MonotonicTime now) {
  if (state_ == PlayerState::Idle && report_.films.empty()) return;
  if (state_ == PlayerState::Idle) return openFilm(film_, now);
  if (apply(PlayerEvent::Play)) {
    held_ = false;
    if (state_ == PlayerState::Playing) {
      setClockHeld(false, now);
      segment_begin_ = clock_.position(now);
    }
  }
  changeRate(1, now);
}

void Player::pause(MonotonicTime now) {
  if (rate_ > 1) changeRate(1, now);  // so that what stands can be touched
  if (!apply(PlayerEvent::Pause)) return;
  held_ = true;
  if (state_ != PlayerState::Paused) return;
  closeSegment(now);
  setClockHeld(true, now);
}

void Player::setClockHeld(bool held, MonotonicTime now) {
  if (auto set = held ? clock_.pause(now) : clock_.resume(now); !set) fail("the film's clock", set.error());
}

void Player::stepPicture(MonotonicTime now) {
  if (rate_ > 1) return pause(now);
  if (!apply(PlayerEvent::Step)) return;
  if (!held_) {
    held_ = true;
    closeSegment(now);
    setClockHeld(true, now);
  }
  head_.refill(feed_);
  if (head_.ahead().empty()) return;  // the last one, or the next is not read yet
  head_.begin();
  clock_.start(head_.present().color.pts, now);  // it stands there
  followSurface();
  showPresent(now);
}

void Player::changeRate(double rate, MonotonicTime now) {
  if (rate == rate_ || !nextState(state_, PlayerEvent::Rate)) return;
  if (rate > 1 && report_.film.duration <= Duration(0)) {
    return note("a live film cannot be wound forward", "it plays on");
  }
  apply(PlayerEvent::Rate);
  const bool rushes = rate > 1 || rate_ > 1;
  const MediaTime here = seekBase(now);
  rate_ = rate;
  static_cast<void>(clock_.setRate(rate, now));  // none of the ladder is refused
  if (rushes) seek(here, PlayerEvent::Seek, false, now);
}

void Player::seekShare(double share, MonotonicTime now) {
  const double whole_s = toSeconds(report_.film.duration);
  if (whole_s > 0) return seek(mediaTime(share * whole_s), PlayerEvent::Seek, true, now);
  note("this film's length is not known", "there is no share of it to seek to");
}

// Where a step of the remote counts from: several presses add up, whether or not the first has been carried out.
MediaTime Player::seekBase(MonotonicTime now) const {
  if (target_) return *target_;
  return place(now).value_or(MediaTime{});
}

// Where the picture is. While it stands for want of the next one, the clock goes on: what is felt fades by it.
std::optional<MediaTime> Player::place(MonotonicTime now) const {
  const auto position = clock_.position(now);
  return position && state_ == PlayerState::Buffering ? head_.present().color.pts : position;
}

void Player::seek(MediaTime target, PlayerEvent why, bool wanted, MonotonicTime now) {
  closeSegment(now);
  if (!apply(why)) return;
  // As the picture stands until the new one comes, so does the surface: what is seen is what is felt.
  if (const auto position = clock_.position(now)) feedSurface({*position, now, 0});
  await_touch_.reset();
  clock_.reset();
  head_.clear();
  sound_.forget();
  target_ = std::max(target, MediaTime{});
  feed_.seek(*target_, rate_ > 1 ? fromSeconds(kRushStepS * rate_) : Duration(0));
  new_epoch_ = true;
  seek_wanted_ = wanted;
  sought_ = now;
  if (wanted) report_.seeks.push_back({toSeconds(*target_), {}, {}});
}

}  // namespace relievo
