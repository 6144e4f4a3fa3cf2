// SPDX-License-Identifier: Apache-2.0
// Remote controls (infra-red, CEC), keyboards and gamepads as input devices of the kernel.
#pragma once

#include <functional>
#include <memory>

#include "hal/remote_input.h"

namespace relievo {

// Reads every input device that has the keys of a remote control (arrows, and one that confirms or plays), and every
// gamepad (pad_keys.h); looks for new ones once a second. A remote is grabbed, so that no other program gets its keys;
// a full keyboard is not, nor a gamepad, which may be the haptic device as well.
// PermissionDenied if there are devices but none may be read. Without any device it opens all the same and waits for
// one.
[[nodiscard]] std::unique_ptr<RemoteInput> makeEvdevRemote();
// Only the gamepads, beside a desktop's keyboard. While `heard` is false, because another window has the focus, what is
// pressed is dropped.
[[nodiscard]] std::unique_ptr<RemoteInput> makePadRemote(std::function<bool()> heard);

}  // namespace relievo
