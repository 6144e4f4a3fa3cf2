// SPDX-License-Identifier: Apache-2.0
// The keyboard of a window as a remote control.
#pragma once

#include <memory>

#include "drivers/window/window_input.h"
#include "hal/remote_input.h"

namespace relievo {

// What was pressed before `open` is not meant for it.
[[nodiscard]] std::unique_ptr<RemoteInput> makeWindowRemote(std::shared_ptr<WindowInput> input);

}  // namespace relievo
