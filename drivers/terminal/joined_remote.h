// SPDX-License-Identifier: Apache-2.0
// The keys of two remotes as those of one: of a window, and of gamepads or the terminal that it was started from.
#pragma once

#include <memory>

#include "hal/remote_input.h"

namespace relievo {

// Opens and fails with the first; the second is left out where it cannot be opened.
[[nodiscard]] std::unique_ptr<RemoteInput> makeJoinedRemote(std::unique_ptr<RemoteInput> first,
                                                            std::unique_ptr<RemoteInput> second);

// The keys of the first, while the terminal drops what is typed into it: a keyboard that the first reads types there as
// well, for the shell. If the first cannot be opened, the terminal's keys are taken instead, and a line says so.
[[nodiscard]] std::unique_ptr<RemoteInput> makeRemoteAtTerminal(std::unique_ptr<RemoteInput> first,
                                                                std::unique_ptr<RemoteInput> terminal);

}  // namespace relievo
