// SPDX-License-Identifier: Apache-2.0
// What a hand does to the keys of a remote control, made out from what the remote sends.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/remote_input.h"

namespace relievo {

// Remotes differ in what they send while a key is held. A keyboard: one press, one release, the kernel's repeats
// between. Infra-red: the same, of which a release may be lost. A television over CEC: press and release; or presses
// again and again and a release at last; or presses again and again and never a release. Here all become one thing: a
// press, repeats at this engine's own pace, a release. A key that is not heard of any more is let go of after kSilence,
// unless this remote is known to send releases.
//
// One key at a time: another one ends the first. Pure arithmetic; times must not go back.
class KeyHold {
 public:
  static constexpr Duration kDelay = std::chrono::milliseconds(500);   // from the press to the first repeat
  static constexpr Duration kPeriod = std::chrono::milliseconds(150);  // between repeats
  static constexpr Duration kSilence = std::chrono::milliseconds(550);

  // What an input_event of EV_KEY says: 0 release, 1 press, 2 the kernel's repeat.
  void take(std::uint16_t code, int value, MonotonicTime now) noexcept;
  // The remote has gone: nothing is held any more.
  void letGo(MonotonicTime now) noexcept;
  // What is next, up to now.
  [[nodiscard]] std::optional<KeyEvent> poll(MonotonicTime now) noexcept;

 private:
  struct Held {
    std::uint16_t code;
    MonotonicTime heard;        // of it last
    MonotonicTime next_repeat;  // due then
  };
  void say(std::uint16_t code, KeyEvent::Action action, MonotonicTime now) noexcept;

  std::optional<Held> held_;
  bool sends_releases_ = false;
  std::array<KeyEvent, 32> said_{};  // a ring; more than a hand can press between two polls
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace relievo
