// SPDX-License-Identifier: Apache-2.0
// What the player does with the film's sound and its words.
#include "app/player/player.h"

namespace relievo {

// False for a command that is none of these.
bool Player::obeySound(const PlayerCommand& command) {
  switch (command.verb) {
    case PlayerVerb::VolumeBy:
      setVolume(loudness_.percent() + command.value);
      return true;
    case PlayerVerb::VolumeTo:
      setVolume(command.value);
      return true;
    case PlayerVerb::Mute:
      mute(command.value == 0 ? !loudness_.muted() : command.value > 0);
      return true;
    default:
      return false;
  }
}

void Player::setVolume(double percent) {
  loudness_.set(percent);
  mute(false);
}

void Player::mute(bool muted) {
  loudness_.mute(muted);
  film_.soundOutput().setGain(loudness_.gain());
}

}  // namespace relievo
