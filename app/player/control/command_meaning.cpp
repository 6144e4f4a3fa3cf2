// SPDX-License-Identifier: Apache-2.0
// What a command does, in words for the help.
#include <cmath>

#include "app/player/control/verb_table.h"
#include "platform/print.h"

namespace relievo {
namespace {

// What a command with a step does, by the step's sign.
std::string stepMeaning(const PlayerCommand& command, const VerbEntry& entry) {
  const bool up = command.value > 0;
  const double by = std::abs(command.value);
  switch (command.verb) {
    case PlayerVerb::DepthBy:
      return print("%.6g %% %s depth for the eyes", 100 * by, up ? "more" : "less");
    case PlayerVerb::ScreenBy:
      return print("the scene %.6g mm %s", by, up ? "towards you" : "away from you");
    case PlayerVerb::ZoomBy:
      return print("%.6g %% %s", 100 * by, up ? "larger, cut at its edges" : "smaller again");
    case PlayerVerb::AudioDelayBy:
    case PlayerVerb::SubtitleDelayBy:
      return print("%s %.6g s %s", entry.meaning, by, up ? "later" : "earlier");
    case PlayerVerb::SubtitleSizeBy:
      return print("subtitles %.6g %% %s", 100 * by, up ? "larger" : "smaller");
    default:
      return print("%+.6g %s", command.value, entry.meaning);
  }
}

}  // namespace

std::string meaningOf(const PlayerCommand& command) {
  const VerbEntry& entry = entryOf(command.verb);
  if (command.verb == PlayerVerb::SeekBy) {
    return print("%.6g s %s", std::abs(command.value), command.value < 0 ? "back" : "forward");
  }
  if (command.verb == PlayerVerb::SeekTo) return print("to %.6g s", command.value);
  if (command.verb == PlayerVerb::SeekShare && command.value == 0) return "to the beginning";
  if (command.verb == PlayerVerb::SeekShare) return print("to %.6g %% of the film", 100 * command.value);
  if (command.verb == PlayerVerb::ChapterBy && std::abs(command.value) == 1) {
    return command.value < 0 ? "this chapter from its beginning, or the one before" : "the next chapter";
  }
  if (command.verb == PlayerVerb::SelectBy) {
    const double films = std::abs(command.value);
    const char* const where = command.value < 0 ? "up" : "down";
    return films == 1 ? print("one film %s", where) : print("%.0f films %s", films, where);
  }
  if (command.verb == PlayerVerb::SelectTo) {
    return command.value == 0   ? "the last film"
           : command.value == 1 ? "the first film"
                                : print("film %.0f", command.value);
  }
  if (command.verb == PlayerVerb::RotateBy)
    return print(command.value < 0 ? "turn it %.0f° back" : "turn the picture %.0f°", std::abs(command.value));
  if (command.verb == PlayerVerb::VolumeBy)
    return print("%.6g %% %s", std::abs(command.value), command.value < 0 ? "quieter" : "louder");
  if (command.verb == PlayerVerb::VolumeTo) return print("%.6g %s", command.value, entry.meaning);
  if (entry.operand == Operand::Track || entry.operand == Operand::TrackOrOff) {
    if (command.value > 0) return print("%s %.0f", entry.word, command.value);
    const bool sound = command.verb == PlayerVerb::AudioTrack;
    if (command.value == kPreviousTrack) return sound ? "the previous sound track" : "the previous subtitles, or none";
    if (command.value < 0) return "no subtitles";
  }
  if (command.verb == PlayerVerb::Mute && command.value != 0) return command.value > 0 ? "sound off" : "sound on";
  if (command.verb == PlayerVerb::ShowSubtitles && command.value != 0) {
    return command.value > 0 ? "subtitles on" : "subtitles off";
  }
  if (command.verb == PlayerVerb::Aspect && !command.word.empty()) return "show the picture as " + command.word;
  if (entry.operand == Operand::Step) return stepMeaning(command, entry);
  if (command.verb == PlayerVerb::Loop && command.value != 0) {
    return command.value > 0 ? "begin again at the end" : "do not restart at the end";
  }
  if (command.verb == PlayerVerb::FullScreen && command.value != 0) {
    return command.value > 0 ? "show full screen" : "leave full screen";
  }
  if (command.verb == PlayerVerb::Layout && !command.word.empty()) return "show stereo as " + command.word;
  return entry.meaning;
}

}  // namespace relievo
