// SPDX-License-Identifier: Apache-2.0
// A terminal's keyboard as a remote control, for use at a PC or over ssh.
#pragma once

#include <memory>

#include "hal/remote_input.h"

namespace relievo {

// While the remote is open, the terminal sends single keys without echo; `close` drops those that were not read, which
// are not meant for the shell, and restores it. Ctrl-C works as usual. Unsupported if `fd` is no terminal; in the
// background there are no keys. A terminal reports only presses: each is followed by a release at once.
[[nodiscard]] std::unique_ptr<RemoteInput> makeTerminalRemote(int fd = 0);

}  // namespace relievo
