// SPDX-License-Identifier: Apache-2.0
// What a viewer can ask of the player, in one vocabulary: of keys, of the key file, of the control socket.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace relievo {

enum class PlayerVerb : std::uint8_t {
  Play,       // at the usual rate
  Pause,      // the picture stands, and stays touchable
  PlayPause,  // the other of the two
  Step,       // the next picture, and stand
  StepBack,   // the previous picture, and stand
  Faster,     // one up of 1/8 1/4 1/2 1 2 4 8 16; from 2 on by key frames, without touch
  Slower,     // one down
  NormalSpeed,
  SeekBy,      // seconds
  SeekTo,      // seconds
  SeekShare,   // of the film's length, 0 to 1
  Next,        // film of the list
  Previous,    // film of the list, or this one from its beginning
  Loop,        // begins again at the end, or no longer; value 1: does, -1: does not, 0: the other of the two
  Open,        // another film or list
  SelectBy,    // films in the list of films that is shown
  SelectTo,    // a film there, by its number from 1 on; 0: the last one
  Choose,      // plays the selected film
  Back,        // to the list of films, where one was shown; else as Stop. In the list, to its first film
  Escape,      // out of full screen; in a window, to the list of films
  Stop,        // ends the film
  Quit,        // ends the program
  Layout,      // another way to show stereo; without its word the next one
  FullScreen,  // on, off, or the other of the two, as Loop: of a window
  SwapEyes,
  DepthBy,   // for the eyes, of 1
  ScreenBy,  // mm, the whole scene towards the viewer
  ZoomBy,    // of 1, the picture in its view
  Aspect,    // the shape that the picture is shown with: "film", "16:9", "4:3", "2.35:1"; without its word the next one
  Info,      // the bar on the screen, or no more
  Statistics,
  Keys,             // what each key means now, on the screen
  Screenshot,       // a PNG of the picture
  VolumeBy,         // percent
  VolumeTo,         // percent
  Mute,             // on, off, or the other of the two, as Loop
  AudioTrack,       // value: its number, from 1 on; 0: the next one
  AudioDelayBy,     // seconds
  SubtitleTrack,    // value: its number, from 1 on, -1: none, 0: the next one, or none after the last
  ShowSubtitles,    // on, off, or the other of the two, as Loop
  SubtitleDelayBy,  // seconds
  SubtitleSizeBy,   // of 1
  ChapterBy,        // chapters; -1: this one's beginning, or the one before it
  LoopAB,           // first the beginning of what is repeated, then its end, then no more
};

struct PlayerCommand {
  PlayerVerb verb = PlayerVerb::Play;
  double value = 0;
  std::string word;  // of Open its URL, of Layout a stereo word (see app/player/screen/stereo_word.h)

  friend bool operator==(const PlayerCommand&, const PlayerCommand&) = default;
};

// "pause", "seek +10", "seek 75", "seek 50%", "depth -0.1", "loop on", "layout tab", "open URL", ..; nothing for what
// is none.
[[nodiscard]] std::optional<PlayerCommand> parseCommand(std::string_view words);
// What is wrong with words that are no command: `unknown command "dance"; known are: ..`, `"loop" takes [on|off], not
// "x"`.
[[nodiscard]] std::string whyNoCommand(std::string_view words);
// Words that `parseCommand` reads back.
[[nodiscard]] std::string wordsOf(const PlayerCommand& command);
// All commands, for a message: "play, pause, .., seek +S|-S|S|P%, ..".
[[nodiscard]] std::string commandWords();
// What the command does, for the help: "pause, or go on", "10 s forward".
[[nodiscard]] std::string meaningOf(const PlayerCommand& command);
// True if the command acts on a film that plays; in the list of films it does nothing.
[[nodiscard]] bool needsFilm(PlayerVerb verb) noexcept;
// True if the command repeats while its key is held down.
[[nodiscard]] bool repeats(PlayerVerb verb) noexcept;

}  // namespace relievo
