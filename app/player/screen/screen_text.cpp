// SPDX-License-Identifier: Apache-2.0
// The words of the screen.
#include "app/player/screen/screen_text.h"

#include <cmath>
#include <utility>

#include "app/player/screen/stereo_word.h"
#include "platform/print.h"

namespace relievo {
namespace {

// What there is to say beside the time.
std::string wordsOf(const ScreenFacts& facts) {
  std::string words;
  const auto add = [&words](const std::string& word) { words += "   " + word; };
  if (facts.held) add("paused");
  else if (facts.state != PlayerState::Playing) add(name(facts.state));
  if (facts.rate != 1) add(facts.rate > 1 ? print("%gx", facts.rate) : print("1/%gx", 1 / facts.rate));
  if (facts.films > 1) add(print("film %zu of %zu", facts.film, facts.films));
  if (facts.loop) add("again and again");
  return words;
}

std::string stereoLine(const ScreenFacts& facts) {
  std::string line = "3D: " + stereoWord(facts.stereo);
  if (!facts.has_depth) return line + ", flat: the film has no depth";
  if (facts.stereo.swap_eyes) line += ", eyes swapped";
  if (facts.stereo.strength != 1.0) line += print(", depth %.0f %%", 100 * facts.stereo.strength);
  return line;
}

std::string hapticLine(const ScreenFacts& facts) {
  if (facts.haptic.empty()) return "touch: no device";
  if (!facts.has_depth) return "touch: " + facts.haptic + ", nothing to feel";
  return "touch: " + facts.haptic + (facts.contact ? ", in contact" : "");
}

}  // namespace

std::string clockTime(double seconds) {
  const auto whole = static_cast<long>(std::max(0.0, seconds));
  if (whole >= 3600) return print("%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  return print("%ld:%02ld", whole / 60, whole % 60);
}

void ScreenText::tell(std::string why, MonotonicTime now) {
  why_ = std::move(why);
  told_until_ = now + 2 * kAwake;
  wake(now);
}

bool ScreenText::shown(const ScreenFacts& facts, MonotonicTime now) const noexcept {
  return wished_ || facts.held || now < awake_until_ || now < told_until_;
}

std::vector<std::string> ScreenText::lines(const ScreenFacts& facts, MonotonicTime now) const {
  if (!shown(facts, now)) return {};
  std::string first = facts.title + "   " + clockTime(facts.position_s);
  if (facts.duration_s > 0) first += " / " + clockTime(facts.duration_s);
  std::vector<std::string> lines{first + wordsOf(facts), stereoLine(facts), hapticLine(facts)};
  if (now < told_until_) lines.push_back(why_);
  return lines;
}

}  // namespace relievo
