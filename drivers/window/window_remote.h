// SPDX-License-Identifier: Apache-2.0
// A window's keyboard as a remote control.
#pragma once

#include <memory>

#include "drivers/window/window_input.h"
#include "hal/remote_input.h"

namespace relievo {

// `open` discards keys that were pressed before.
[[nodiscard]] std::unique_ptr<RemoteInput> makeWindowRemote(std::shared_ptr<WindowInput> input);

}  // namespace relievo
