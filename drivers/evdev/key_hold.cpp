// SPDX-License-Identifier: Apache-2.0
// Key states: one held key, its next repeat, and its release after silence.
#include "drivers/evdev/key_hold.h"

#include <linux/input-event-codes.h>

#include <algorithm>

namespace relievo {
namespace {

constexpr std::array<std::uint16_t, 4> kModifiers{KEY_LEFTSHIFT, KEY_RIGHTSHIFT, KEY_LEFTCTRL, KEY_RIGHTCTRL};

}  // namespace

void KeyHold::take(std::uint16_t code, int value, MonotonicTime now) noexcept {
  const auto modifier = std::ranges::find(kModifiers, code);
  if (modifier != kModifiers.end()) {
    return turnModifier(static_cast<std::size_t>(modifier - kModifiers.begin()), value != 0, now);
  }
  if (value == 0) {
    sends_releases_ = true;
    if (held_ && held_->code == code) endHeld(now);
    return;
  }
  if (held_ && held_->code == code) {
    held_->heard = now;
    return;
  }
  if (value != 1) return;  // a repeat of a key that another key has ended
  endHeld(now);
  say(code, KeyEvent::Action::Press, now);
  held_ = Held{code, now, now + kDelay};
}

void KeyHold::letGo(MonotonicTime now) noexcept {
  endHeld(now);
  for (std::size_t i = 0; i < kModifiers.size(); ++i) turnModifier(i, false, now);
}

void KeyHold::endHeld(MonotonicTime now) noexcept {
  if (held_) say(held_->code, KeyEvent::Action::Release, now);
  held_.reset();
}

void KeyHold::turnModifier(std::size_t which, bool down, MonotonicTime now) noexcept {
  if (modifiers_down_[which] == down) return;
  modifiers_down_[which] = down;
  say(kModifiers[which], down ? KeyEvent::Action::Press : KeyEvent::Action::Release, now);
}

std::optional<KeyEvent> KeyHold::poll(MonotonicTime now) noexcept {
  if (held_ && !sends_releases_ && now - held_->heard > kSilence) endHeld(now);
  if (held_ && count_ == 0 && now >= held_->next_repeat) {
    say(held_->code, KeyEvent::Action::Repeat, now);
    // After a long gap between polls, the missed repeats are skipped.
    held_->next_repeat = now + kPeriod;
  }
  if (count_ == 0) return std::nullopt;
  const KeyEvent event = said_[first_];
  first_ = (first_ + 1) % said_.size();
  --count_;
  return event;
}

void KeyHold::say(std::uint16_t code, KeyEvent::Action action, MonotonicTime now) noexcept {
  if (count_ == said_.size()) return;
  said_[(first_ + count_++) % said_.size()] = {code, action, now};
}

}  // namespace relievo
