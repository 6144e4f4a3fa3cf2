// SPDX-License-Identifier: Apache-2.0
// Fills in what the command line and the configuration leave open: display, devices, the list of films.
#pragma once

#include "app/player/setup/options.h"
#include "platform/failure.h"

namespace relievo {

// Sets what `play` does not name from the machine's devices. InvalidArgument if there is nothing to play, or a named
// device needs a window where there is none.
[[nodiscard]] Outcome<void> settlePlay(PlayOptions& play, const Machine& machine);

}  // namespace relievo
