// SPDX-License-Identifier: Apache-2.0
// Which key of a remote control, a keyboard or CEC means which command.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/remote_input.h"

namespace relievo {

enum class PlayerCommand : std::uint8_t {
  Play,
  Pause,
  PlayPause,
  SeekForward,  // by kSeekStep
  SeekBackward,
  NextLayout,  // the next way to show stereo
  SwapEyes,
  DeeperPicture,
  FlatterPicture,
  ScreenForward,  // the whole scene towards the viewer
  ScreenBackward,
  Info,  // the text on the screen, or no more
  Stop,  // ends the film, and with it the program
};

// Nothing for a key that means nothing here, for a release, and for the repeat of a key that makes no sense repeated.
[[nodiscard]] std::optional<PlayerCommand> commandOf(const KeyEvent& key) noexcept;

// For the help: a line for each command, with the keys' names as linux/input-event-codes.h has them, without KEY_.
[[nodiscard]] std::string keyHelp();

}  // namespace relievo
