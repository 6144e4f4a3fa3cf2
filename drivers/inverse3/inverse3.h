// SPDX-License-Identifier: Apache-2.0
// The Haply Inverse3 as a haptic device, through the maker's service.
#pragma once

#include <memory>
#include <string>

#include "drivers/inverse3/wire.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"

namespace relievo {

struct Inverse3Config {
  inverse3::Address address;
  bool watchdog_thread = true;  // false: only `read` checks, for simulated time
};

// For the service's versions 3.1 to 3.5, port 10001: a message with a force each tick, an answer with the position.
// `home` waits until the service says that the device is ready, or until `cancel` or Lost: the encoders are absolute.
// The force fades in over half a second after `start`, and again after each time that the position was unknown.
// Buttons: a, b, c of the grip are the bits 0, 1, 2. The service does not say which grip is at which arm: of a device
// alone they are those of any grip; with a second one each has the grip at its arm's place in the service's lists, if
// these are equally long.
// Of a service's arms it takes the first that no other device of this process has, and keeps to it when opened again.
// Safety: the watchdog sends zero 6 ms after the last message with a force, and ends the connection if that cannot be
// sent; so do `stop`, `close` and the destructor. While no position younger than 6 ms is known, because the answers are
// late, unreadable or such as no hand can have caused, zero is sent; after 100 ms the device is Lost. However the
// process ends, the kernel ends the connection, and the service, which applies no force for longer than it is asked to,
// lets the device go.
//
// The workspace is the Inverse3's, or that of a Minverse at the same service.
//
// Frame: x right, y up, z toward the user, origin in the middle of the workspace.
[[nodiscard]] std::unique_ptr<HapticDevice> makeInverse3(const Inverse3Config& config,
                                                         std::unique_ptr<inverse3::Wire> wire, Clock& clock);
// Over TCP.
[[nodiscard]] std::unique_ptr<HapticDevice> makeInverse3(const Inverse3Config& config, Clock& clock);

}  // namespace relievo
