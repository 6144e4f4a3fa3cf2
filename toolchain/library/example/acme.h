// SPDX-License-Identifier: Apache-2.0
// Acme's arm: a haptic device with three motors and incremental encoders, which rests in a cradle.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "hal/haptic_device.h"
#include "platform/clock.h"
#include "platform/error.h"
#include "platform/realtime.h"

namespace acme {

// The connection to the arm, as an interface that a test can replace. In the arm's own axes: left, toward the user, up.
class Wire {
 public:
  virtual ~Wire() = default;
  virtual relievo::Result<void> open() = 0;  // NotFound, PermissionDenied
  virtual void close() noexcept = 0;
  // One exchange each; Lost if the arm has gone away. `drive` on any thread.
  virtual relievo::Result<std::array<std::int16_t, 3>> counts() RELIEVO_RT = 0;  // since it was switched on, 50 a mm
  virtual relievo::Result<void> drive(const std::array<std::int16_t, 3>& milliamps) RELIEVO_RT = 0;  // 250 mA a N
};

// `clock` must outlive the device. `watchdog_thread`: false for simulated time, where only `read` watches.
[[nodiscard]] std::unique_ptr<relievo::HapticDevice> makeArm(std::unique_ptr<Wire> wire, const relievo::Clock& clock,
                                                             bool watchdog_thread = true);

}  // namespace acme
