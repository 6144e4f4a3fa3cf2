// SPDX-License-Identifier: Apache-2.0
// Which of a device's axes and keys do what, and where they stand.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "drivers/gamepad/pad_port.h"
#include "platform/realtime.h"

namespace relievo {

// The stick is ABS_X and ABS_Y. A wheel is recognised by its name, or by an ABS_Y whose range differs from that of
// ABS_X: there ABS_Y is a pedal, and the hat moves the finger up and down. Triggers and pedals are ABS_GAS and
// ABS_BRAKE, ABS_HAT2X and ABS_HAT2Y if they count from 0; also ABS_Z and ABS_RZ, on a wheel, or on a pad that has a
// second stick at ABS_RX and ABS_RY. Of a joystick that pushes, ABS_RZ is the twist. A wheel's pedals may rest at their
// upper end; the first position that each reports shows which. Without triggers and pedals, a key presses.
//
// The kernel has 0 for an axis that has not reported yet, whatever its range: until then a stick counts as let go, a
// trigger as not pulled.
class PadControls {
 public:
  PadControls() = default;
  explicit PadControls(const PadFacts& facts) noexcept;

  [[nodiscard]] bool isWheel() const noexcept { return wheel_; }

  void take(const input_event& event) RELIEVO_RT;
  // Call after lost events, with the kernel's state of the keys.
  void setKeys(const InputKeys& down) RELIEVO_RT { down_ = down; }
  // Likewise of an axis.
  void setAxis(unsigned code, std::int32_t value) RELIEVO_RT { learn(code, value, value != 0); }
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
    bool heard = false;                             // a position has been reported
    bool inverted = false;                          // rests at its upper end
    [[nodiscard]] double share() const RELIEVO_RT;  // 0 at the low end, 1 at the high one
  };
  static Axis axisOf(const PadFacts& facts, unsigned code) noexcept;
  void findTriggers(const PadFacts& facts) noexcept;
  [[nodiscard]] bool mayPress(const PadFacts& facts, unsigned code) const noexcept;
  void findKeys(const InputKeys& keys) noexcept;

  // `reported`: the device has said so itself.
  void learn(unsigned code, std::int32_t value, bool reported) RELIEVO_RT;

  bool wheel_ = false;
  std::array<Axis, 2> stick_{};
  std::array<Axis, 7> triggers_{};
  unsigned press_key_ = KEY_CNT;
  std::array<unsigned, 2> button_keys_{KEY_CNT, KEY_CNT};
  InputKeys down_;
};

}  // namespace relievo
