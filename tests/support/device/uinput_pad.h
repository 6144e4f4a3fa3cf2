// SPDX-License-Identifier: Apache-2.0
// A gamepad or a wheel that the kernel creates and removes (uinput): plays the test's events and shows what effects it
// was given.
#pragma once

#include <array>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "drivers/gamepad/pad_port.h"
#include "platform/unique_fd.h"

namespace relievo::test {

class UinputPad {
 public:
  // True only in toolchain/guest: its kernel has uinput, and its time is virtual, which limits of milliseconds need.
  static bool canBeMade();
  explicit UinputPad(const PadFacts& facts);
  UinputPad(const UinputPad&) = delete;
  UinputPad& operator=(const UinputPad&) = delete;
  ~UinputPad() = default;

  [[nodiscard]] std::string node() const { return node_; }  // /dev/input/eventN
  void turn(std::uint16_t axis, std::int32_t value) const;
  void press(std::uint16_t key, bool down) const;

  struct Effect {
    bool made = false, playing = false;
    ff_effect level{};
  };
  // The effect of this type in its present state; all zero if there is none.
  [[nodiscard]] Effect effect(std::uint16_t type) const;
  [[nodiscard]] bool plays() const;
  [[nodiscard]] bool hasEffects() const;
  [[nodiscard]] int centring() const;  // as sent last; -1 before
  [[nodiscard]] int gain() const;

 private:
  void serve(const std::stop_token& stopping);
  void obey(const input_event& event);
  void say(std::uint16_t type, std::uint16_t code, std::int32_t value) const;

  UniqueFd fd_;
  std::string node_;
  mutable std::mutex lock_;  // of all that follows
  std::array<Effect, 16> effects_{};
  int centring_ = -1, gain_ = -1;
  std::jthread thread_;  // the last member, so that it ends first
};

}  // namespace relievo::test
