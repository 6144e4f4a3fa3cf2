// SPDX-License-Identifier: Apache-2.0
// How long a tick takes, by method, in one run on one machine.
#pragma once

#include <span>
#include <vector>

#include "app/lab/film/film_run.h"
#include "app/lab/measure/contenders.h"
#include "app/lab/numbers/statistics.h"

namespace relievo {

// In microseconds, without the clock's own cost. `update`: from position to force; `whole`: that and the upkeep. These
// spreads are of all ticks of all rounds, with whatever else the machine did meanwhile. `own`: of each tick of the
// path, the median over the rounds, which removes interruptions: the method's work at a tick is the same in every
// round.
struct TickTimes {
  Spread update, upkeep, whole;
  Spread own_update, own_upkeep, own_whole;
  double frame_ms = 0;  // time that the method needs for each frame of depth before a tick can use it: the shortest
  double frame_us_per_tick = 0;  // the same, spread over the ticks of a frame

  // The full cost of a tick.
  [[nodiscard]] double medianUs() const { return whole.median + frame_us_per_tick; }
  [[nodiscard]] double p999Us() const { return whole.p999 + frame_us_per_tick; }
};

struct TimedPath {
  const FilmViews& film;
  std::span<const HipTick> path;
  std::size_t skipped_ticks = 0;  // at the path's beginning, until the finger is in contact
};

// The median difference of two successive clock readings.
[[nodiscard]] Duration clockCost();

// Runs `rounds` times: every contender once along the whole path, one after the other, and the blur of one frame, so
// that other work on the machine affects all alike. One entry per contender.
[[nodiscard]] std::vector<TickTimes> timeTicks(std::span<const Contender* const> contenders, const TimedPath& timed,
                                               int rounds);
// With cold caches: `ticks` of them in one round, then a few blurs; before each, untimed, 96 MB are read and written.
[[nodiscard]] std::vector<TickTimes> timeColdTicks(std::span<const Contender* const> contenders, const TimedPath& timed,
                                                   std::size_t ticks);

}  // namespace relievo
