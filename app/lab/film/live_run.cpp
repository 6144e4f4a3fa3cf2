// SPDX-License-Identifier: Apache-2.0
// The player's rules for a live film (look_ahead.h), on a list of arrivals.
#include "app/lab/film/live_run.h"

#include <algorithm>
#include <random>

namespace relievo {
namespace {

// In order: a frame never overtakes the one before it.
std::vector<double> arrivalsOf(std::span<const TimedSurface> frames, const CameraDelay& delay) {
  std::mt19937_64 random(delay.seed);
  std::uniform_real_distribution<double> late(0, 2 * toSeconds(delay.jitter));
  std::vector<double> there_s;
  double last = 0;
  for (const TimedSurface& frame : frames) {
    last = std::max(last, toSeconds(frame.time) + toSeconds(delay.least) + late(random));
    there_s.push_back(last);
  }
  return there_s;
}

}  // namespace

LiveRun::LiveRun(const MemoryFilm& film, TouchMethod& method, const LookAhead& ahead, const CameraDelay& delay)
    : film_(film),
      method_(method),
      ahead_(ahead),
      there_s_(arrivalsOf(film.frames(), delay)),
      feed_(film.frames(), [this](std::size_t frame, double now_s) { return there_s_[frame] <= now_s; }) {
  method_.reset();
}

void LiveRun::hear(double now_s) {
  for (; heard_ < there_s_.size() && there_s_[heard_] <= now_s; ++heard_) {
    const MediaTime time = film_.frames()[heard_].time;
    arrivals_.add(time, fromSeconds(there_s_[heard_] - toSeconds(time)));
  }
}

void LiveRun::steer(double now_s) {
  const double target = now_s - toSeconds(arrivals_.age(ahead_));
  if (!begun_) wanted_s_ = target;
  else wanted_s_ += (now_s - now_s_) * rateToGain(fromSeconds(target - wanted_s_ - (now_s - now_s_)));
  begun_ = heard_ > static_cast<std::size_t>(ahead_.frames) + 1;  // until then the age is a guess
  now_s_ = now_s;
}

PlayedTick LiveRun::tick(const HipTick& hip) {
  hear(hip.t_s);
  steer(hip.t_s);
  const MediaTime now = mediaTime(wanted_s_);
  static_cast<void>(feed_.update(now, hip.t_s, 0, window_));
  window_.carried = ahead_.carried;
  felt_s_ = wanted_s_;
  if (window_.count > 0) {
    const MediaTime newest = window_.frames[static_cast<std::size_t>(window_.count - 1)].time;
    felt_s_ = std::min(wanted_s_, toSeconds(newest + ahead_.carried));
  }
  PlayedTick played{.t_s = hip.t_s, .hip_mm = hip.hip_mm};
  played.touch = method_.update(hip.hip_mm, window_, now);
  method_.upkeep(window_, now);
  return played;
}

}  // namespace relievo
