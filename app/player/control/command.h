// SPDX-License-Identifier: Apache-2.0
// The commands of a viewer, in one vocabulary for keys, the key file and the control socket.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace relievo {

enum class PlayerVerb : std::uint8_t {
  Play,       // at the usual rate
  Pause,      // the picture stands, and stays touchable
  PlayPause,  // toggles
  Step,       // shows the next picture, paused
  StepBack,   // shows the previous picture, paused
  Faster,     // one up of 1/8 1/4 1/2 1 2 4 8 16; from 2 on by key frames, without touch
  Slower,     // one down
  NormalSpeed,
  SeekBy,      // seconds
  SeekTo,      // seconds
  SeekShare,   // of the film's length, 0 to 1
  Next,        // film of the list
  Previous,    // film of the list, or this one from its beginning
  Loop,        // plays again from the beginning at the end; value 1: on, -1: off, 0: toggles
  Open,        // another film or list
  SelectBy,    // films in the list of films that is shown
  SelectTo,    // a film there, by its number from 1 on; 0: the last one
  Choose,      // plays the selected film
  Back,        // to the list of films, if one was shown; else like Stop. In the list: selects its first film
  Escape,      // leaves full screen; in a window, goes to the list of films
  Stop,        // ends the film
  Quit,        // ends the program
  Layout,      // stereo layout; without a word the next one
  FullScreen,  // of a window; on, off or toggle, as Loop
  SwapEyes,
  DepthBy,   // factor on the depth for the eyes, added
  ScreenBy,  // mm, the whole scene towards the viewer
  ZoomBy,    // factor on the picture's size in its view, added
  Aspect,    // the picture's shape: "film", "16:9", "4:3", "2.35:1"; without a word the next one
  RotateBy,  // degrees clockwise, of the picture: 90, 180 or 270, or back
  Info,      // toggles the bar on the screen
  Statistics,
  Keys,             // shows what each key means now
  Screenshot,       // a PNG of the picture
  VolumeBy,         // percent
  VolumeTo,         // percent
  Mute,             // on, off or toggle, as Loop
  AudioTrack,       // value: its number, from 1 on; 0: the next one; kPreviousTrack
  AudioDelayBy,     // seconds
  SubtitleTrack,    // value: its number, from 1 on, -1: none, 0: the next one, or none after the last; kPreviousTrack
  ShowSubtitles,    // on, off or toggle, as Loop
  SubtitleDelayBy,  // seconds
  SubtitleSizeBy,   // factor, added
  ChapterBy,        // chapters; -1: to this one's beginning, or to the one before it
  LoopAB,           // first sets one end of the repeated part, then the other, then clears both
};

// The value of AudioTrack and SubtitleTrack for the one before; before the first one are no subtitles.
inline constexpr double kPreviousTrack = -2;

struct PlayerCommand {
  PlayerVerb verb = PlayerVerb::Play;
  double value = 0;
  std::string word;  // for Open the URL, for Layout a stereo word (see app/player/screen/stereo_word.h)

  friend bool operator==(const PlayerCommand&, const PlayerCommand&) = default;
};

// "pause", "seek +10", "seek 75", "seek 50%", "depth -0.1", "loop on", "layout tab", "open URL", ..; nullopt if it is
// no command.
[[nodiscard]] std::optional<PlayerCommand> parseCommand(std::string_view words);
// Says what is wrong with words that are no command: `unknown command "dance"; known are: ..`, `"loop" takes [on|off],
// not "x"`.
[[nodiscard]] std::string whyNoCommand(std::string_view words);
// All commands, for a message: "play, pause, .., seek +S|-S|S|P%, ..".
[[nodiscard]] std::string commandWords();
// What the command does, for the help: "pause, or go on", "10 s forward".
[[nodiscard]] std::string meaningOf(const PlayerCommand& command);
// True if the command acts on a film that plays; in the list of films it does nothing.
[[nodiscard]] bool needsFilm(PlayerVerb verb) noexcept;
// True if the command repeats while its key is held down.
[[nodiscard]] bool repeats(PlayerVerb verb) noexcept;

}  // namespace relievo
