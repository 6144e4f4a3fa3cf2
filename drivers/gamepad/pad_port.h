// SPDX-License-Identifier: Apache-2.0
// What the driver needs of a gamepad, a joystick or a wheel: the kernel's events in, its force effects out. Tests fake
// it.
#pragma once

#include <linux/input.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "platform/error.h"
#include "platform/realtime.h"

namespace relievo {

// A set of the kernel's codes, as its requests fill it.
template <std::size_t Codes>
struct InputCodes {
  std::array<std::uint8_t, (Codes + 7) / 8> bytes{};
  [[nodiscard]] bool has(unsigned code) const RELIEVO_RT {
    return code < Codes && (bytes[code / 8] >> (code % 8) & 1U) != 0;
  }
  void put(unsigned code, bool in = true) RELIEVO_RT {
    if (code >= Codes) return;
    const auto bit = static_cast<std::uint8_t>(1U << code % 8);
    bytes[code / 8] = static_cast<std::uint8_t>(in ? bytes[code / 8] | bit : bytes[code / 8] & ~bit);
  }
};
using InputKeys = InputCodes<KEY_CNT>;

// What a device reports about itself.
struct PadFacts {
  std::string name;
  InputKeys keys;
  InputCodes<ABS_CNT> axes;
  InputCodes<FF_CNT> forces;
  std::array<input_absinfo, ABS_CNT> ranges{};  // of the axes that it has, with their present values
  int effects_at_once = 0;
};

// `open` and `close` on the owner's thread. `take`, `keysDown` and `axis` on the real-time thread, one system call
// each: `take` never waits; the others, needed only after lost events, wait for an upload that is under way. `upload`,
// `erase` and `send` on one thread at a time; the first two may wait for the device. Lost: the device has gone away.
class PadPort {
 public:
  virtual ~PadPort() = default;

  // NotFound, PermissionDenied; Unsupported if it has no stick or no force feedback.
  [[nodiscard]] virtual Result<PadFacts> open() = 0;
  // The kernel then erases the remaining effects.
  virtual void close() noexcept = 0;

  // Reads the oldest pending events and returns their number, or 0.
  [[nodiscard]] virtual Result<std::size_t> take(std::span<input_event> events) RELIEVO_RT = 0;
  [[nodiscard]] virtual Result<InputKeys> keysDown() RELIEVO_RT = 0;
  [[nodiscard]] virtual Result<std::int32_t> axis(unsigned code) RELIEVO_RT = 0;

  // Makes a new effect (id -1) or changes one; returns its id.
  [[nodiscard]] virtual Result<std::int16_t> upload(const ff_effect& effect) noexcept = 0;
  [[nodiscard]] virtual Result<void> erase(std::int16_t id) noexcept = 0;
  // An event of type EV_FF: an effect's id with 1 to play it and 0 to stop it; FF_GAIN, FF_AUTOCENTER.
  [[nodiscard]] virtual Result<void> send(std::uint16_t code, std::int32_t value) noexcept = 0;
};

// `path`: /dev/input/eventN, or empty for the first device with a stick and force feedback.
[[nodiscard]] std::unique_ptr<PadPort> makeEvdevPadPort(std::string path);

// Whether it has a stick and a kind of force that this driver uses.
[[nodiscard]] bool isPad(const PadFacts& facts) noexcept;
// Whether it is a gamepad, a joystick or a wheel that lacks only such a force.
[[nodiscard]] bool isPadWithoutForce(const PadFacts& facts) noexcept;

}  // namespace relievo
