// SPDX-License-Identifier: Apache-2.0
// Translates a viewer's command into the actions of the player in the present situation. Pure; the player then checks
// each against its state table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "app/player/control/command.h"
#include "app/player/state_table.h"
#include "hal/media/media_source.h"
#include "hal/media/media_time.h"
#include "platform/clock.h"

namespace relievo {

struct Situation {
  PlayerState state = PlayerState::Idle;
  bool held = false;   // the viewer wants the film paused
  double rate = 1;     // over 1: key frames only
  MediaTime here;      // the position, or the target of a pending seek
  Duration length{0};  // of the film; 0: unknown or live
  std::span<const Chapter> chapters;
  MediaTime picture;   // time of the shown picture
  Duration period{0};  // from picture to picture
  std::size_t film = 0, films = 1;
  bool wraps = false;       // the first film follows the last one
  bool film_asked = false;  // a film has been opened since the player started
};

struct Deed {
  enum class Kind : std::uint8_t {
    GoOn,      // resume
    Stand,     // pause
    StepOn,    // show the next picture and stay paused
    Rate,      // at `rate`
    Seek,      // to `target`; `by_viewer`: it is reported
    OpenFilm,  // entry `film` of the list; `back`: the viewer moves backwards
  };
  Kind kind = Kind::GoOn;
  double rate = 1;
  MediaTime target;
  bool by_viewer = false;
  std::size_t film = 0;
  bool back = false;
};

// The actions, in order, for commands that control playback or choose a film of the list. Empty for other commands, and
// for those that have no effect in this situation.
[[nodiscard]] std::vector<Deed> deedsFor(const PlayerCommand& command, const Situation& situation);

}  // namespace relievo
