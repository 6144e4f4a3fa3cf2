// SPDX-License-Identifier: Apache-2.0
// Which of a device's axes and keys do what, and where they stand.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "drivers/gamepad/pad_port.h"
#include "platform/realtime.h"

namespace relievo {

// The stick is ABS_X and ABS_Y. A wheel is recognised by an ABS_Y whose range differs from that of ABS_X: there ABS_Y
// is a pedal, and the hat moves the finger up and down. Triggers and pedals are ABS_GAS and ABS_BRAKE; also ABS_Z and
// ABS_RZ, on a wheel or if there is a second stick at ABS_RX and ABS_RY. A wheel's pedals may rest at their upper end;
// the first position that each reports shows which. Without triggers and pedals, a key presses.
class PadControls {
 public:
  PadControls() = default;
  explicit PadControls(const PadFacts& facts) noexcept;

  [[nodiscard]] bool isWheel() const noexcept { return wheel_; }

  void take(const input_event& event) RELIEVO_RT;
  // Call after lost events, with the kernel's state of the keys.
  void setKeys(const InputKeys& down) RELIEVO_RT { down_ = down; }
  void setAxis(unsigned code, std::int32_t value) RELIEVO_RT;
  // The axes whose state to ask for after lost events.
  [[nodiscard]] bool uses(unsigned code) const RELIEVO_RT;

  [[nodiscard]] glm::dvec2 stick() const RELIEVO_RT;  // from -1 to 1, x right, y up
  [[nodiscard]] double pull() const RELIEVO_RT;       // from 0 to 1, of the trigger that is pulled most
  [[nodiscard]] std::uint32_t buttons() const RELIEVO_RT;

 private:
  struct Axis {
    unsigned code = ABS_CNT;  // none
    double low = 0, high = 1;
    double value = 0;
    bool heard = false;                             // a position has been reported, so the rest position is known
    bool inverted = false;                          // rests at its upper end
    [[nodiscard]] double share() const RELIEVO_RT;  // 0 at the low end, 1 at the high one
  };
  static Axis axisOf(const PadFacts& facts, unsigned code) noexcept;
  void findTriggers(const PadFacts& facts) noexcept;
  void findKeys(const InputKeys& keys) noexcept;

  bool wheel_ = false;
  std::array<Axis, 2> stick_{};
  std::array<Axis, 5> triggers_{};
  unsigned press_key_ = KEY_CNT;
  std::array<unsigned, 2> button_keys_{KEY_CNT, KEY_CNT};
  InputKeys down_;
};

}  // namespace relievo
