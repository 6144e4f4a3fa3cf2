// SPDX-License-Identifier: Apache-2.0
// How long a tick takes, by method, in one run on one machine.
#pragma once

#include <span>
#include <vector>

#include "app/lab/film/film_run.h"
#include "app/lab/measure/contenders.h"
#include "app/lab/numbers/statistics.h"

namespace relievo {

// In microseconds, the clock's own cost taken off. `update`: from position to force; `whole`: that and the upkeep. The
// spreads are of all ticks of all rounds, with whatever else the machine did meanwhile. `own`: each tick of the path
// stands for itself, with its median over the rounds; what the method does there it does in every round, and an
// interruption comes in one.
struct TickTimes {
  Spread update, upkeep, whole;
  Spread own_update, own_upkeep, own_whole;
  double frame_ms = 0;  // that the method needs for every frame of depth before a tick can use it: the quickest
  double frame_us_per_tick = 0;  // the same, spread over the ticks of a frame

  // What a tick costs in all.
  [[nodiscard]] double medianUs() const { return whole.median + frame_us_per_tick; }
  [[nodiscard]] double p999Us() const { return whole.p999 + frame_us_per_tick; }
};

struct TimedPath {
  const FilmViews& film;
  std::span<const HipTick> path;
  std::size_t skipped_ticks = 0;  // at the path's begin, until the finger is in
};

// Median of what two readings of the clock one after the other differ by.
[[nodiscard]] Duration clockCost();

// `rounds` times: every contender once along the whole path, one after the other, and the blur of one frame, so that
// what else the machine does hits all alike. One entry per contender.
[[nodiscard]] std::vector<TickTimes> timeTicks(std::span<const Contender* const> contenders, const TimedPath& timed,
                                               int rounds);
// Ticks alone, with cold caches: `ticks` of them, and before each 96 MB are read and written, not timed; one round.
[[nodiscard]] std::vector<TickTimes> timeColdTicks(std::span<const Contender* const> contenders, const TimedPath& timed,
                                                   std::size_t ticks);

}  // namespace relievo
