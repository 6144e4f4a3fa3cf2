// SPDX-License-Identifier: Apache-2.0
// The player's states and events, and the one table that says which event leads where.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace relievo {

enum class PlayerState : std::uint8_t {
  Boot,       // devices are being opened
  Idle,       // no film
  Browsing,   // the list of films is shown
  Opening,    // the source is being opened
  Buffering,  // pairs are being read ahead; the picture stands
  Playing,
  Paused,   // the picture and the surface stand, and stay touchable
  Seeking,  // the reader is on its way to another time
  Ended,    // the last picture has had its time
  Fault,    // the film cannot go on
};
inline constexpr std::size_t kPlayerStateCount = 10;

enum class PlayerEvent : std::uint8_t {
  Ready,       // the devices are open, or are known to be missing
  Browse,      // the list of films is wanted
  Open,        // a film is wanted, or another one
  Opened,      // its source is open
  Filled,      // enough pairs are read ahead: play
  FilledHeld,  // likewise, but the viewer wants it paused
  Play,        // the viewer's wish
  Pause,       // the viewer's wish
  Step,        // the viewer's wish: the next picture, and stand
  Rate,        // the viewer's wish: slower or faster
  Seek,        // the viewer's wish
  Sought,      // the reader has arrived
  Starved,     // no pair when one was due
  EndOfFilm,   // nothing follows
  Loop,        // from the beginning again
  Stop,        // the viewer's wish, a signal, or the time is up
  Fail,        // something the film cannot go on without is lost
};
inline constexpr std::size_t kPlayerEventCount = 17;

// Where `event` leads from `state`; nothing where it is refused. A wish that changes no state but is heard (pause while
// buffering) leads back to the same state.
[[nodiscard]] std::optional<PlayerState> nextState(PlayerState state, PlayerEvent event) noexcept;

[[nodiscard]] const char* name(PlayerState state) noexcept;  // "boot", "idle", .. as in the report
[[nodiscard]] const char* name(PlayerEvent event) noexcept;  // "ready", "end of film", ..

// The table as a drawing, for Graphviz: dot -Tsvg.
[[nodiscard]] std::string stateGraph();

}  // namespace relievo
