// SPDX-License-Identifier: Apache-2.0
// Turns what a remote control sends for a held key into a press, repeats and a release.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/remote_input.h"

namespace relievo {

// Remotes differ in what they send while a key is held. A keyboard: one press, the kernel's repeats, one release.
// Infra-red: the same, but the release may get lost. A television over CEC: press and release; or repeated presses and
// a final release; or repeated presses without any release. All become a press, repeats at a rate of its own, and a
// release. After kSilence without events a key counts as released, unless this remote has sent a release
// before.
//
// One key at a time: another one ends the first. Shift and Ctrl are beside it: they end nothing and do not repeat. Pure
// arithmetic; times must not go back.
class KeyHold {
 public:
  static constexpr Duration kDelay = std::chrono::milliseconds(500);   // from the press to the first repeat
  static constexpr Duration kPeriod = std::chrono::milliseconds(150);  // between repeats
  static constexpr Duration kSilence = std::chrono::milliseconds(550);

  // `sends_releases`: this remote is known to.
  explicit KeyHold(bool sends_releases = false) noexcept : sends_releases_(sends_releases) {}

  // `value` of an EV_KEY input_event: 0 release, 1 press, 2 repeat by the kernel.
  void take(std::uint16_t code, int value, MonotonicTime now) noexcept;
  // The remote was unplugged: releases what is held.
  void letGo(MonotonicTime now) noexcept;
  // The next event up to `now`.
  [[nodiscard]] std::optional<KeyEvent> poll(MonotonicTime now) noexcept;

 private:
  struct Held {
    std::uint16_t code;
    MonotonicTime heard;        // time of its last event
    MonotonicTime next_repeat;  // when due
  };
  void endHeld(MonotonicTime now) noexcept;
  void turnModifier(std::size_t which, bool down, MonotonicTime now) noexcept;
  void say(std::uint16_t code, KeyEvent::Action action, MonotonicTime now) noexcept;

  std::optional<Held> held_;
  std::array<bool, 4> modifiers_down_{};
  bool sends_releases_;
  std::array<KeyEvent, 32> said_{};  // a ring; holds more than a hand can press between two polls
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace relievo
