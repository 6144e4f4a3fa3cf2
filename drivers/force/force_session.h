// SPDX-License-Identifier: Apache-2.0
// A haptic driver's use of its USB port while forces may flow: fades the force in, runs the watchdog, ends with zero
// force, and reports a device that stops answering.
#pragma once

#include "drivers/force/force_port.h"
#include "drivers/force/watchdog.h"
#include "platform/clock.h"

namespace relievo {

// `begin`, `beginForces` and `end` on the owner's thread, the rest on the real-time one.
class ForceSession {
 public:
  // `patience`: after that time without a command the watchdog takes the force away.
  ForceSession(ForcePort& port, Clock& clock, Duration patience = Watchdog::kPatience)
      : port_(port), clock_(clock), watchdog_(port, patience) {}
  ~ForceSession() { end(); }
  ForceSession(const ForceSession&) = delete;
  ForceSession& operator=(const ForceSession&) = delete;

  // Starts the port's exchange; `quiet` is the command that stops the motors. For homing: no force flows.
  [[nodiscard]] Result<void> begin(PortBytes quiet);
  // As `begin`, but forces follow. Without a thread of its own the watchdog checks only in `listened`.
  [[nodiscard]] Result<void> beginForces(PortBytes quiet, bool watchdog_thread);
  // Sends zero force and stops the exchange. Does nothing if none is running.
  void end() noexcept;

  // Call once a tick, after reading what has arrived. `known`: whether the hand's position is known. Lost after 100 ms
  // without an answer.
  [[nodiscard]] Result<void> listened(bool answered, bool known = true) RELIEVO_RT;

  struct Share {
    // The fraction of the force to send: rises from 0 to 1 within half a second, again from 0 after the watchdog has
    // stopped the motors, and is 0 while the hand's position is unknown, that is once the device has not answered for
    // the watchdog's time.
    double of_force = 0;
    double elapsed_s = 0;  // since the last call
  };
  // Call once for each force.
  [[nodiscard]] Share nextShare() RELIEVO_RT;
  [[nodiscard]] Result<void> send(PortBytes command) RELIEVO_RT;

 private:
  ForcePort& port_;
  Clock& clock_;
  Watchdog watchdog_;
  bool exchanging_ = false;
  bool blind_ = false;  // the hand's position is not known
  double fade_ = 0;
  MonotonicTime last_share_, heard_;
};

}  // namespace relievo
