// SPDX-License-Identifier: Apache-2.0
// The remote controls of a living room: infra-red, CEC and keyboards are all input devices of the kernel.
#pragma once

#include <memory>

#include "hal/remote_input.h"

namespace relievo {

// Every input device that has the keys of a remote control (arrows, and one that confirms or plays), those that come
// later as well: it looks for new ones once a second. A remote is grabbed, so that its keys reach nobody else; a whole
// keyboard is not. PermissionDenied where there are devices and none may be read; a box without any is Open all the
// same, and waits for one.
[[nodiscard]] std::unique_ptr<RemoteInput> makeEvdevRemote();

}  // namespace relievo
