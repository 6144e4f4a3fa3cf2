// SPDX-License-Identifier: Apache-2.0
// What the player does with keys, the mouse and commands.
#include <linux/input-event-codes.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <utility>

#include "app/media/playlist.h"
#include "app/player/player.h"
#include "app/player/screen/notices.h"
#include "platform/print.h"

namespace relievo {
namespace {

// In the list of films, the keys for playing a film have no effect.
bool isForAnotherTime(const PlayerCommand& command, PlayerState state) noexcept {
  return state == PlayerState::Browsing && needsFilm(command.verb);
}

// A held key that does so waits until the picture of the last seek has been shown: else none would be.
bool leavesPicture(PlayerVerb verb) noexcept {
  return verb == PlayerVerb::SeekBy || verb == PlayerVerb::StepBack || verb == PlayerVerb::Step;
}

// Pages of keys that a key turns by; 0: it is none of these.
int pagesBy(std::uint16_t code) noexcept {
  constexpr std::array<std::uint16_t, 6> kOn{KEY_DOWN, KEY_RIGHT, KEY_PAGEDOWN, BTN_DPAD_DOWN, BTN_DPAD_RIGHT, BTN_TR};
  constexpr std::array<std::uint16_t, 6> kBack{KEY_UP, KEY_LEFT, KEY_PAGEUP, BTN_DPAD_UP, BTN_DPAD_LEFT, BTN_TL};
  if (std::ranges::find(kOn, code) != kOn.end()) return 1;
  return std::ranges::find(kBack, code) != kBack.end() ? -1 : 0;
}

// Commands that need what only an open film has: pictures, a length, depth, tracks, chapters.
constexpr std::array kOfAnOpenFilm{PlayerVerb::DepthBy,       PlayerVerb::ScreenBy,  PlayerVerb::Step,
                                   PlayerVerb::StepBack,      PlayerVerb::Faster,    PlayerVerb::Slower,
                                   PlayerVerb::NormalSpeed,   PlayerVerb::SeekShare, PlayerVerb::AudioTrack,
                                   PlayerVerb::ChapterBy,     PlayerVerb::LoopAB,    PlayerVerb::SubtitleTrack,
                                   PlayerVerb::ShowSubtitles, PlayerVerb::RotateBy};

// What the film itself does not have.
std::optional<std::string> lack(const PlayerCommand& command, double rate, const FilmInfo& film) {
  const auto is = [&](PlayerVerb verb) { return verb == command.verb; };
  const bool has_length = film.duration > Duration(0);
  if (is(PlayerVerb::ChapterBy) && film.chapters.empty()) return "this film has no chapters";
  if (is(PlayerVerb::SeekShare) && !has_length) return "this film's length is not known";
  if (is(PlayerVerb::Faster) && rate >= 1 && !has_length) return "a live film has no fast forward";
  if ((is(PlayerVerb::DepthBy) || is(PlayerVerb::ScreenBy)) && !film.has_depth)
    return "this film has no depth to change";
  if (is(PlayerVerb::RotateBy) && hasTwoViews(film.packing)) {
    return "a film of two views cannot be turned";  // its disparities are sideways
  }
  const bool sound = command.verb == PlayerVerb::AudioTrack;
  if (!sound && command.verb != PlayerVerb::SubtitleTrack) return std::nullopt;
  const std::size_t tracks = sound ? film.sounds.size() : film.subtitles.size();
  if (command.value <= static_cast<double>(tracks)) return std::nullopt;
  return print("there is no %s %.0f; the film has %zu", sound ? "sound track" : "subtitle track", command.value,
               tracks);
}

}  // namespace

void Player::readRemote(MonotonicTime now) {
  const bool has_pad = parts_.remote != nullptr && parts_.remote->hasPad();
  if (has_pad != has_pad_) {
    has_pad_ = has_pad;
    nameKeys();
  }
  while (parts_.remote != nullptr) {
    const auto key = parts_.remote->poll(now);
    if (!key) {
      journal_.note(std::string("remote: ") + key.error().message, "the film goes on without one");
      parts_.remote->close();
      parts_.remote = nullptr;
      return;
    }
    if (!*key) break;
    const auto command = keys_.take(**key, state_);
    const bool again = command && (*key)->action == KeyEvent::Action::Repeat;
    if (again && film_.isSeeking() && leavesPicture(command->verb)) continue;
    if (command && !isForAnotherTime(*command, state_)) obeyKey(*command, (*key)->code, now);
    else noteUnbound(**key, now);
  }
  if (const auto command = keys_.held(now)) obeyKey(*command, 0, now);
}

// Nobody sees what a key does beneath the page of keys: there it turns the pages, or closes them. The volume is heard.
void Player::obeyKey(const PlayerCommand& command, std::uint16_t code, MonotonicTime now) {
  constexpr std::array kObeyed{PlayerVerb::Keys, PlayerVerb::VolumeBy, PlayerVerb::VolumeTo, PlayerVerb::Mute};
  ScreenText& text = screen_.text();
  if (!text.showsKeys() || std::ranges::find(kObeyed, command.verb) != kObeyed.end()) return obey(command, now);
  if (const int pages = pagesBy(code); pages != 0) return text.turnPage(pages);
  text.hideKeys();
}

// Called within the display's `attend`. The right button comes as a key: it pauses, also over the bar, and closes the
// page of keys.
bool Player::hearMouse(const SurfaceMouse& mouse) {
  const bool clicks = mouse.notches == 0 && mouse_.press(mouse.pressed);  // the wheel knows no button
  if (screen_.text().showsKeys()) {
    screen_.text().turnPage(-mouse.notches);
    if (clicks) screen_.text().hideKeys();
    return mouse.pressed || mouse.notches != 0;
  }
  if (state_ == PlayerState::Browsing) return hearMouseInList(mouse, clicks);
  if (mouse.notches != 0) {
    const bool is_volume = screen_.isOverBar(mouse) || !config_.mouse_touches || !film_.info().has_depth;
    if (is_volume) mouse_.turn(mouse.notches);
    return is_volume;
  }
  SurfaceMouse at_bar = mouse;
  at_bar.pressed = mouse.pressed && (clicks || screen_.dragsBar());  // a press that began elsewhere is not the bar's
  const auto share = screen_.barAt(at_bar, parts_.clock.now());
  if (share && at_bar.pressed) mouse_.drag(*share);
  const auto button = screen_.buttonAt(mouse);
  if (button && clicks) mouse_.click(*button);
  return mouse.pressed && (share || button);
}

// Until a seek has shown its picture the mouse may move on; its last position is used.
void Player::followMouse(MonotonicTime now) {
  constexpr double kLouder = 5;  // percent a notch of the wheel
  if (const int notches = mouse_.takeNotches(); notches != 0) obey({PlayerVerb::VolumeBy, kLouder * notches}, now);
  if (const auto verb = mouse_.takeClick()) obey({*verb}, now);
  if (film_.isSeeking()) return;
  if (const auto share = mouse_.takeDrag()) obey({PlayerVerb::SeekShare, *share}, now);
}

// A key without a meaning is reported once. Modifier keys are not reported.
void Player::noteUnbound(const KeyEvent& key, MonotonicTime now) {
  constexpr std::array<std::uint16_t, 8> kSilent{KEY_LEFTSHIFT, KEY_RIGHTSHIFT, KEY_LEFTCTRL, KEY_RIGHTCTRL,
                                                 KEY_LEFTALT,   KEY_RIGHTALT,   KEY_LEFTMETA, KEY_RIGHTMETA};
  if (key.action != KeyEvent::Action::Press) return;
  const KeyTable::Binding* const binding = config_.keys.find(state_, key.code);
  if (binding != nullptr && (!binding->press || !isForAnotherTime(*binding->press, state_))) return;
  if (std::ranges::find(kSilent, key.code) != kSilent.end()) return;
  if (screen_.text().showsKeys()) return screen_.text().hideKeys();
  if (!unbound_.insert(key.code).second) return;
  const std::string label = keyLabel(key.code, config_.held);
  screen_.text().notice({(label.empty() ? "This key" : label) + " has no meaning here", std::nullopt}, now);
}

// The key that shows all keys: with a gamepad the gamepad's, since it is in the viewer's hands.
std::string Player::helpKey() const {
  return config_.keys.keyFor(PlayerVerb::Keys, PlayerState::Playing, has_pad_ ? KeyBoard::Pad : config_.held);
}

void Player::nameKeys() {
  screen_.text().setKeyNames(helpKey(), has_pad_ ? padLabel(BTN_SOUTH) : "Enter or OK");
}

ScreenRows Player::keyRows() const {
  ScreenRows rows;
  const bool touches = config_.mouse_touches && film_.info().has_depth;
  if (config_.has_mouse) rows = mouseRows(state_ == PlayerState::Browsing, touches);
  if (has_pad_) std::ranges::move(config_.keys.rowsIn(state_, KeyBoard::Pad), std::back_inserter(rows));
  std::ranges::move(config_.keys.rowsIn(state_, config_.held), std::back_inserter(rows));
  return rows;
}

std::optional<std::string> Player::refusal(const PlayerCommand& command) const {
  if (auto why = browsingRefusal(command)) return why;
  if (!needsFilm(command.verb)) return std::nullopt;
  if (!film_.isOpen()) {
    constexpr std::array kOpening{PlayerVerb::Play, PlayerVerb::PlayPause, PlayerVerb::Next, PlayerVerb::Previous};
    const bool opens = std::ranges::find(kOpening, command.verb) != kOpening.end();
    if (opens && state_ == PlayerState::Idle && programme_.asked()) return std::nullopt;
    return state_ == PlayerState::Browsing ? "no film is open; choose one" : "no film is open; open one first";
  }
  const auto is = [&](PlayerVerb verb) { return verb == command.verb; };
  if (state_ == PlayerState::Opening && std::ranges::any_of(kOfAnOpenFilm, is)) return "the film is still being opened";
  const bool steps = is(PlayerVerb::Step) || is(PlayerVerb::StepBack);
  if (steps && !film_.rushes() && !nextState(state_, PlayerEvent::Step)) return "there is no picture to step from yet";
  if (auto why = lack(command, film_.rate(), film_.info())) return why;
  const std::size_t film = placeOnShelf().value_or(programme_.present());
  const std::size_t films = placeOnShelf() ? browser_->shelf().size() : programme_.size();
  if (!is(PlayerVerb::Next) || film + 1 < films || programme_.wraps()) return std::nullopt;
  return films == 1 ? "no next film: this one is played alone" : "this is the last film of the list";
}

void Player::obey(const PlayerCommand& command, MonotonicTime now) {
  const bool leaves = command.verb == PlayerVerb::Escape || command.verb == PlayerVerb::Back;
  if (leaves && screen_.text().showsKeys()) return screen_.text().hideKeys();
  if (auto why = refusal(command)) {
    why->front() = static_cast<char>(std::toupper(static_cast<unsigned char>(why->front())));
    return screen_.text().notice({std::move(*why), std::nullopt}, now);
  }
  switch (command.verb) {
    case PlayerVerb::Quit:
      quitting_ = true;
      return;
    case PlayerVerb::Open:
      return openList({{.url = sourceNamed(command.word), .depth_url = "", .title = ""}}, now);
    case PlayerVerb::Stop:
      return stopFilm(now);
    case PlayerVerb::Loop:
      programme_.setLoop(command.value == 0 ? !programme_.loops() : command.value > 0);
      break;
    case PlayerVerb::Screenshot:
      return screen_.saveScreenshot(fileName());
    case PlayerVerb::Keys:
      return screen_.turnKeys(keyRows());
    default:
      break;
  }
  if (obeyBrowsing(command, now)) return;
  if (!obeySound(command, now)) obeyPicture(command, now);
  if (auto notice = noticeOf(command, facts())) screen_.text().notice(std::move(*notice), now);
  else screen_.wake(now);
}

void Player::obeyPicture(const PlayerCommand& command, MonotonicTime now) {
  screen_.obey(command);
  if (command.verb == PlayerVerb::RotateBy) turnPicture(static_cast<int>(command.value) / 90, now);
  for (const Deed& deed : deedsFor(command, situation(now))) carryOut(deed, now);
}

Situation Player::situation(MonotonicTime now) const {
  const auto place = placeOnShelf();
  return {.state = state_,
          .held = film_.held(),
          .rate = film_.rate(),
          .here = config_.start.value_or(film_.goal(now)),
          .length = film_.info().duration,
          .chapters = film_.info().chapters,
          .picture = film_.picture().color.pts,
          .period = film_.period(),
          .film = place.value_or(programme_.present()),
          .films = place ? browser_->shelf().size() : programme_.size(),
          .wraps = programme_.wraps(),
          .film_asked = programme_.asked()};
}

}  // namespace relievo
