// SPDX-License-Identifier: Apache-2.0
// What the command line and the configuration leave open: display, devices, the list of films.
#pragma once

#include "app/player/setup/options.h"
#include "platform/failure.h"

namespace relievo {

// Names what `play` does not name, by what the machine has. InvalidArgument if there is nothing to play, or a device is
// named that needs a window where there is none.
[[nodiscard]] Outcome<void> settlePlay(PlayOptions& play, const Machine& machine);

}  // namespace relievo
