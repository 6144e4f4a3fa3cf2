// SPDX-License-Identifier: Apache-2.0
// A player's command as the words that `parseCommand` reads back.
#pragma once

#include <string>

#include "app/player/control/command.h"
#include "app/player/control/verb_table.h"
#include "platform/print.h"

namespace relievo::test {

inline std::string wordsOf(const PlayerCommand& command) {
  std::string word = entryOf(command.verb).word;
  switch (command.verb) {
    case PlayerVerb::SeekBy:
    case PlayerVerb::DepthBy:
    case PlayerVerb::ScreenBy:
    case PlayerVerb::ZoomBy:
    case PlayerVerb::RotateBy:
    case PlayerVerb::VolumeBy:
    case PlayerVerb::AudioDelayBy:
    case PlayerVerb::SubtitleDelayBy:
    case PlayerVerb::SubtitleSizeBy:
    case PlayerVerb::ChapterBy:
    case PlayerVerb::SelectBy:
      return word + print(" %+.6g", command.value);
    case PlayerVerb::AudioTrack:
    case PlayerVerb::SubtitleTrack:
      if (command.value == 0) return word;
      if (command.value == kPreviousTrack) return word + " previous";
      return word + (command.value < 0 ? std::string(" off") : print(" %.0f", command.value));
    case PlayerVerb::SelectTo:
      if (command.value == 0) return word + " last";
      [[fallthrough]];
    case PlayerVerb::SeekTo:
    case PlayerVerb::VolumeTo:
      return word + print(" %.6g", command.value);
    case PlayerVerb::SeekShare:
      return word + print(" %.6g%%", 100 * command.value);
    case PlayerVerb::Loop:
    case PlayerVerb::FullScreen:
    case PlayerVerb::Mute:
    case PlayerVerb::ShowSubtitles:
      return command.value == 0 ? word : word + (command.value > 0 ? " on" : " off");
    case PlayerVerb::Open:
    case PlayerVerb::Layout:
    case PlayerVerb::Aspect:
      return command.word.empty() ? word : word + " " + command.word;
    default:
      return word;
  }
}

}  // namespace relievo::test
