// SPDX-License-Identifier: Apache-2.0
// What a viewer's command asks of the player in the present situation. Pure: who is asked decides by the state table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/player/control/command.h"
#include "app/player/state_table.h"
#include "hal/media_time.h"
#include "platform/clock.h"

namespace relievo {

struct Situation {
  PlayerState state = PlayerState::Idle;
  bool held = false;   // the viewer wants the film paused
  double rate = 1;     // over 1: it rushes by, by key frames
  MediaTime here;      // where the film is, or is sought to
  Duration length{0};  // of the film; 0: not known, or live
  std::size_t film = 0, films = 1;
  bool film_asked = false;  // since the player runs
};

struct Deed {
  enum class Kind : std::uint8_t {
    GoOn,      // play
    Stand,     // pause
    StepOn,    // the next picture, and stand
    Rate,      // at `rate`
    Seek,      // to `target`; `by_viewer`: for the report
    OpenFilm,  // `film` of the list; `back`: the viewer goes back through it
    Note,      // it cannot be done: `what`, and what is done instead
  };
  Kind kind = Kind::GoOn;
  double rate = 1;
  MediaTime target;
  bool by_viewer = false;
  std::size_t film = 0;
  bool back = false;
  const char* what = "";
  const char* done = "";
};

// The deeds in their order. For the commands about how the film goes and which one of the list is played; none for the
// others, and for what means nothing in this situation.
[[nodiscard]] std::vector<Deed> deedsFor(const PlayerCommand& command, const Situation& situation);

}  // namespace relievo
