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
  Buffering,  // pairs are being read ahead; the picture is paused
  Playing,
  Paused,   // picture and surface are still; the surface can be touched
  Seeking,  // the reader is seeking
  Ended,    // the last picture has been shown for its whole time
  Fault,    // the film cannot go on
};
inline constexpr std::size_t kPlayerStateCount = 10;

enum class PlayerEvent : std::uint8_t {
  Ready,       // the devices are open, or are known to be missing
  Browse,      // the list of films is requested
  Open,        // a film is requested, or another one
  Opened,      // its source is open
  Filled,      // enough pairs are read ahead: play
  FilledHeld,  // likewise, but the viewer has paused the film
  Play,        // viewer's request
  Pause,       // viewer's request
  Step,        // viewer's request: the next picture, paused
  Rate,        // viewer's request: slower or faster
  Seek,        // viewer's request
  Sought,      // the reader has arrived
  Starved,     // no pair when one was due
  EndOfFilm,   // nothing follows
  Loop,        // from the beginning again
  Stop,        // viewer's request, a signal, or the end of the allowed time
  Fail,        // something that the film needs is lost
};
inline constexpr std::size_t kPlayerEventCount = 17;

// The state after `event` in `state`; nullopt if the event is refused. A request that is accepted without changing the
// state (pause while buffering) leads to the same state.
[[nodiscard]] std::optional<PlayerState> nextState(PlayerState state, PlayerEvent event) noexcept;

[[nodiscard]] const char* name(PlayerState state) noexcept;  // "boot", "idle", .. as in the report
[[nodiscard]] const char* name(PlayerEvent event) noexcept;  // "ready", "end of film", ..

// The table as a drawing, for Graphviz: dot -Tsvg.
[[nodiscard]] std::string stateGraph();

}  // namespace relievo
