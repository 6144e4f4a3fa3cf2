// SPDX-License-Identifier: Apache-2.0
// How a haptic driver uses its port while forces may flow: faded in, watched, ended with zero, and given up after
// silence.
#pragma once

#include "drivers/usb/usb_port.h"
#include "drivers/usb/watchdog.h"
#include "platform/clock.h"

namespace relievo {

// `begin`, `beginForces` and `end` on the owner's thread, the rest on the real-time one.
class ForceSession {
 public:
  ForceSession(UsbPort& port, Clock& clock) : port_(port), clock_(clock), watchdog_(port) {}
  ~ForceSession() { end(); }
  ForceSession(const ForceSession&) = delete;
  ForceSession& operator=(const ForceSession&) = delete;

  // Starts the port's exchange; `quiet` is the command that stops the motors. For homing: no force flows.
  [[nodiscard]] Result<void> begin(UsbBytes quiet);
  // The same, and forces follow. Without a thread of its own the watchdog looks from `listened` alone.
  [[nodiscard]] Result<void> beginForces(UsbBytes quiet, bool watchdog_thread);
  // Zero force, then no exchange. Does nothing when there is none.
  void end() noexcept;

  // Once a tick, when what has arrived was looked at. Lost after 100 ms without an answer.
  [[nodiscard]] Result<void> listened(bool answered) RELIEVO_RT;

  struct Share {
    // That may go out: from 0 to 1 within half a second, anew after the watchdog has barked, and none while the device
    // has not answered for as long as that one waits: where the hand is is not known then.
    double of_force = 0;
    double elapsed_s = 0;  // since the last one
  };
  // Once for each force.
  [[nodiscard]] Share nextShare() RELIEVO_RT;
  [[nodiscard]] Result<void> send(UsbBytes command) RELIEVO_RT;

 private:
  UsbPort& port_;
  Clock& clock_;
  Watchdog watchdog_;
  bool exchanging_ = false;
  double fade_ = 0;
  MonotonicTime last_share_, heard_;
};

}  // namespace relievo
