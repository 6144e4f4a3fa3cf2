// SPDX-License-Identifier: Apache-2.0
// Which of a device's axes and keys do what, and where they stand.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "drivers/gamepad/pad_port.h"
#include "platform/realtime.h"

namespace relievo {

// The stick is ABS_X and ABS_Y. A wheel has only ABS_X, which is told by ABS_Y having another range: there it is a
// pedal, and the hat moves the finger up and down. Triggers and pedals are ABS_GAS and ABS_BRAKE; ABS_Z and ABS_RZ, if
// there is a second stick at ABS_RX and ABS_RY or if it is a wheel. A wheel's pedals may stand at their upper end when
// nobody presses; the first position that each tells shows that. Without any, a key presses.
class PadControls {
 public:
  PadControls() = default;
  explicit PadControls(const PadFacts& facts) noexcept;

  [[nodiscard]] bool isWheel() const noexcept { return wheel_; }

  void take(const input_event& event) RELIEVO_RT;
  // After lost events: the state as the kernel has it.
  void setKeys(const InputKeys& down) RELIEVO_RT { down_ = down; }
  void setAxis(unsigned code, std::int32_t value) RELIEVO_RT;
  // The axes that matter, to be asked for after lost events.
  [[nodiscard]] bool uses(unsigned code) const RELIEVO_RT;

  [[nodiscard]] glm::dvec2 stick() const RELIEVO_RT;  // from -1 to 1, x right, y up
  [[nodiscard]] double pull() const RELIEVO_RT;       // from 0 to 1, of the trigger that is pulled most
  [[nodiscard]] std::uint32_t buttons() const RELIEVO_RT;

 private:
  struct Axis {
    unsigned code = ABS_CNT;  // none
    double low = 0, high = 1;
    double value = 0;
    bool heard = false;                             // its rest is known
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
