// SPDX-License-Identifier: Apache-2.0
// The key table. CEC keys come as the codes that the kernel's rc-cec map gives them; sets differ in which of two codes
// for the same word they send, so both are here.
#include "app/player/key_table.h"

#include <linux/input-event-codes.h>

#include <array>

namespace relievo {
namespace {

struct Binding {
  std::uint16_t code;
  PlayerCommand command;
  bool repeats = false;
};

constexpr std::array kBindings{
    Binding{KEY_PLAY, PlayerCommand::Play},
    Binding{KEY_PLAYCD, PlayerCommand::Play},
    Binding{KEY_PAUSE, PlayerCommand::Pause},
    Binding{KEY_PAUSECD, PlayerCommand::Pause},
    Binding{KEY_PLAYPAUSE, PlayerCommand::PlayPause},
    Binding{KEY_OK, PlayerCommand::PlayPause},
    Binding{KEY_ENTER, PlayerCommand::PlayPause},
    Binding{KEY_SELECT, PlayerCommand::PlayPause},
    Binding{KEY_SPACE, PlayerCommand::PlayPause},
    Binding{KEY_RIGHT, PlayerCommand::SeekForward, true},
    Binding{KEY_FASTFORWARD, PlayerCommand::SeekForward, true},
    Binding{KEY_LEFT, PlayerCommand::SeekBackward, true},
    Binding{KEY_REWIND, PlayerCommand::SeekBackward, true},
    Binding{KEY_3D_MODE, PlayerCommand::NextLayout},
    Binding{KEY_STOP, PlayerCommand::Stop},
    Binding{KEY_STOPCD, PlayerCommand::Stop},
    Binding{KEY_BACK, PlayerCommand::Stop},
    Binding{KEY_EXIT, PlayerCommand::Stop},
    Binding{KEY_ESC, PlayerCommand::Stop},
    Binding{KEY_POWER, PlayerCommand::Stop},
};

}  // namespace

std::optional<PlayerCommand> commandOf(const KeyEvent& key) noexcept {
  if (key.action == KeyEvent::Action::Release) return std::nullopt;
  for (const Binding& binding : kBindings) {
    if (binding.code != key.code) continue;
    if (key.action == KeyEvent::Action::Repeat && !binding.repeats) return std::nullopt;
    return binding.command;
  }
  return std::nullopt;
}

}  // namespace relievo
