// SPDX-License-Identifier: Apache-2.0
// The commands of a haptic device over any bus: what a force session and its watchdog need of a port.
#pragma once

#include <cstdint>
#include <span>

#include "platform/error.h"
#include "platform/realtime.h"

namespace relievo {

using PortBytes = std::span<const std::uint8_t>;

// `startExchange` and `stopExchange` on the owner's thread; `post` on one real-time thread, only between the two; it
// never waits. Every call returns Lost once the device has gone.
class ForcePort {
 public:
  virtual ~ForcePort() = default;

  // `quiet` is what `quieten` sends: the command that stops the motors.
  [[nodiscard]] virtual Result<void> startExchange(PortBytes quiet) = 0;
  // Sends a command. False if the device cannot take it now; it is then not sent.
  [[nodiscard]] virtual Result<bool> post(PortBytes bytes) RELIEVO_RT = 0;
  virtual void stopExchange() noexcept = 0;

  // Discards a posted command that was not sent yet, sends the quiet one and waits for it, 20 ms at most. False if the
  // device did not accept it. Any thread, while an exchange runs.
  virtual bool quieten() noexcept = 0;
};

}  // namespace relievo
