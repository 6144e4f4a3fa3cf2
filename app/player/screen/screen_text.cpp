// SPDX-License-Identifier: Apache-2.0
// The words of the screen.
#include "app/player/screen/screen_text.h"

#include <algorithm>
#include <cmath>

#include "app/player/screen/stereo_word.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kBarSteps = 2000;    // that the bar's length is rounded to
constexpr double kFingerSteps = 200;  // likewise the finger's place
constexpr double kForceStepsPerN = 20;

std::string timesOf(const ScreenFacts& facts) {
  const bool has_length = facts.duration_s > 0;
  // A last picture stands beyond the film's length while the film is held or begins again.
  std::string times = clockTime(has_length ? std::min(facts.position_s, facts.duration_s) : facts.position_s);
  if (has_length) times += " / " + clockTime(facts.duration_s);
  const auto add = [&times](const std::string& word) { times += "   " + word; };
  const bool opens = facts.state == PlayerState::Opening;
  if (opens || (!facts.held && facts.state != PlayerState::Playing)) add(name(facts.state));
  if (facts.held) add("paused");
  if (facts.rate != 1) add(facts.rate > 1 ? print("%gx", facts.rate) : print("1/%gx", 1 / facts.rate));
  if (facts.films > 1) add(print("film %zu of %zu", facts.film, facts.films));
  if (facts.loop) add("repeat");
  return times;
}

std::string stereoWords(const ScreenFacts& facts) {
  std::string words = "3D: " + stereoTitle(facts.stereo);
  if (facts.stereo.swap_eyes) words += ", eyes swapped";
  if (facts.stereo.strength != 1.0) words += print(", depth %.0f %%", 100 * facts.stereo.strength);
  return words;
}

std::string hapticWords(const ScreenFacts& facts) {
  std::string words;
  if (!facts.has_depth) return "no depth in this film, nothing to feel";
  for (const FingerFacts& finger : facts.fingers) {
    if (finger.haptic.empty()) continue;
    const std::string device = finger.haptic == "pointer" ? "mouse" : finger.haptic;
    words += (words.empty() ? "" : " and ") + device + (finger.contact ? ", in contact" : "");
  }
  return "touch: " + (words.empty() ? "no device" : words);
}

// Of a film that is being opened nothing is known.
std::string statusOf(const ScreenFacts& facts) {
  return facts.state == PlayerState::Opening ? "" : stereoWords(facts) + "   " + hapticWords(facts);
}

std::string buttonWord(PlayerVerb verb, const ScreenFacts& facts) {
  switch (verb) {
    case PlayerVerb::PlayPause:
      return facts.held ? "Play" : "Pause";
    case PlayerVerb::SubtitleTrack:
      return "Subtitles";
    case PlayerVerb::AudioTrack:
      return "Sound";
    case PlayerVerb::Layout:
      return "3D";
    case PlayerVerb::FullScreen:
      return facts.full_screen ? "Window" : "Full screen";
    case PlayerVerb::Next:
      return "Next";
    case PlayerVerb::Back:
      return "Films";
    default:
      return "?";
  }
}

double rounded(double value, double steps) noexcept {
  return std::round(value * steps) / steps;
}

std::optional<FingerBeside> besideOf(const FingerFacts& finger) {
  if (!finger.across || !finger.up) return std::nullopt;
  const FingerBeside beside{rounded(*finger.across, kFingerSteps), rounded(*finger.up, kFingerSteps)};
  const bool inside = std::abs(beside.across) <= 0.5 && std::abs(beside.up) <= 0.5;
  return inside ? std::nullopt : std::optional(beside);
}

}  // namespace

std::string clockTime(double seconds) {
  const auto whole = static_cast<long>(std::max(0.0, seconds));
  if (whole >= 3600) return print("%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  return print("%ld:%02ld", whole / 60, whole % 60);
}

void ScreenText::turnKeys(ScreenRows keys, std::size_t pages) {
  const bool goes_on = showsKeys() && keys_page_ + 1 < pages;
  keys_page_ = goes_on ? keys_page_ + 1 : 0;
  if (showsKeys() && !goes_on) return hideKeys();
  keys_ = std::move(keys);
  keys_pages_ = pages;
}

void ScreenText::turnPage(int by) noexcept {
  const auto last = static_cast<std::ptrdiff_t>(keys_pages_) - 1;
  const auto wished = static_cast<std::ptrdiff_t>(keys_page_) + by;
  keys_page_ = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(wished, 0, std::max<std::ptrdiff_t>(last, 0)));
}

void ScreenText::setKeyNames(std::string help, std::string choose) {
  help_key_ = std::move(help);
  choose_key_ = std::move(choose);
}

void ScreenText::tell(std::string why, MonotonicTime now) {
  why_ = std::move(why);
  told_until_ = now + 2 * kAwake;
  wake(now);
}

void ScreenText::notice(ScreenNotice notice, MonotonicTime now) {
  notice_ = std::move(notice);
  noticed_until_ = now + kNotice;
}

void ScreenText::hint(std::string words, MonotonicTime now) {
  hint_ = std::move(words);
  hinted_until_ = now + kNotice;
}

void ScreenText::point(std::optional<double> share, std::optional<PlayerVerb> button, MonotonicTime now) {
  pointed_ = share;
  pointed_button_ = button;
  pointed_until_ = now + kAwake;
}

bool ScreenText::showsBar(const ScreenFacts& facts, MonotonicTime now) const noexcept {
  return bar_ || facts.held || now < awake_until_ || now < told_until_;
}

ScreenBar ScreenText::bar(const ScreenFacts& facts, MonotonicTime now) const {
  ScreenBar bar{
      .title = facts.title, .times = timesOf(facts), .status = statusOf(facts), .has_length = facts.duration_s > 0};
  for (const PlayerVerb verb : facts.buttons) bar.buttons.push_back({verb, buttonWord(verb, facts)});
  if (now < pointed_until_) bar.pointed_button = pointed_button_;
  if (!bar.has_length) return bar;
  const auto share = [&](double seconds) {
    return rounded(std::clamp(seconds / facts.duration_s, 0.0, 1.0), kBarSteps);
  };
  bar.position = share(facts.position_s);
  bar.buffered = std::max(bar.position, share(facts.buffered_s));
  for (const double start : chapters_s_) bar.chapters.push_back(share(start));
  if (facts.loop_from_s) bar.loop_from = share(*facts.loop_from_s);
  if (facts.loop_to_s) bar.loop_to = share(*facts.loop_to_s);
  if (pointed_ && now < pointed_until_) {
    bar.pointed = rounded(*pointed_, kBarSteps);
    bar.pointed_time = clockTime(*pointed_ * facts.duration_s);
  }
  return bar;
}

ScreenContent ScreenText::content(const ScreenFacts& facts, const ScreenRows& statistics, MonotonicTime now) const {
  ScreenContent content;
  if (now < noticed_until_) content.notice = notice_;
  content.keys = keys_;
  if (!keys_.empty() || list_) content.help_key = help_key_;
  if (!keys_.empty()) content.keys_page = keys_page_;
  if (!keys_.empty()) return content;
  if (now < told_until_) content.warning = why_;
  content.list = list_;
  if (list_) content.choose_key = choose_key_;
  if (list_) return content;
  const bool shows_bar = showsBar(facts, now);
  if (shows_bar) content.bar = bar(facts, now);
  for (std::size_t i = 0; i < facts.fingers.size(); ++i) {
    const FingerFacts& finger = facts.fingers[i];
    content.fingers[i] = besideOf(finger);
    if (shows_bar && facts.has_depth && !finger.haptic.empty()) {
      content.forces_n[i] = rounded(finger.force_n, kForceStepsPerN);
    }
  }
  if (now < hinted_until_) content.hint = hint_;
  if (statistics_) content.statistics = statistics;
  return content;
}

}  // namespace relievo
