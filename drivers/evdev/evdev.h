// SPDX-License-Identifier: Apache-2.0
// Remote controls (infra-red, CEC) and keyboards as input devices of the kernel.
#pragma once

#include <memory>

#include "hal/remote_input.h"

namespace relievo {

// Reads every input device that has the keys of a remote control (arrows, and one that confirms or plays); looks for
// new ones once a second. A remote is grabbed, so that no other program gets its keys; a full keyboard is not.
// PermissionDenied if there are devices but none may be read. Without any device it opens all the same and waits for
// one.
[[nodiscard]] std::unique_ptr<RemoteInput> makeEvdevRemote();

}  // namespace relievo
