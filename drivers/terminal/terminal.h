// SPDX-License-Identifier: Apache-2.0
// Remote control on a terminal: for people at a PC, over ssh as well.
#pragma once

#include <memory>

#include "hal/remote_input.h"

namespace relievo {

// The terminal yields its keys one by one and unechoed while the remote is open, and is put back as it was by `close`.
// Ctrl-C and Ctrl-Z remain the shell's. Unsupported where `fd` is no terminal; in the background there are no keys.
// A terminal tells presses alone: each is followed by its release at once.
[[nodiscard]] std::unique_ptr<RemoteInput> makeTerminalRemote(int fd = 0);

}  // namespace relievo
