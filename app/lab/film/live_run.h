// SPDX-License-Identifier: Apache-2.0
// A film as a camera sends it: every frame some time after it was taken, felt at an age that follows how late they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/depth_window/look_ahead.h"
#include "app/haptics/method/method.h"
#include "app/lab/film/film_run.h"
#include "app/lab/film/memory_feed.h"

namespace relievo {

// How late a camera's frames come: `least` and up to `jitter` to either side of the middle, evenly spread.
struct CameraDelay {
  Duration least = std::chrono::milliseconds(2);
  Duration jitter = std::chrono::milliseconds(5);
  std::uint64_t seed = 1;
};

// One method on one film, tick by tick from the film's first frame on, on virtual time. `film` and `method` outlive it;
// the method is reset.
class LiveRun {
 public:
  LiveRun(const MemoryFilm& film, TouchMethod& method, const LookAhead& ahead, const CameraDelay& delay);

  // `hip.t_s` is the present moment; the surface is that of an earlier one (`feltS`). `truth` is left to the caller.
  [[nodiscard]] PlayedTick tick(const HipTick& hip);
  // The moment of the surface that was felt in the last tick. If the frame that it waits for has not come, the time of
  // the newest one, carried forward.
  [[nodiscard]] double feltS() const { return felt_s_; }
  [[nodiscard]] const Arrivals& arrivals() const { return arrivals_; }

 private:
  void hear(double now_s);
  void steer(double now_s);

  const MemoryFilm& film_;
  TouchMethod& method_;
  LookAhead ahead_;
  std::vector<double> there_s_;  // when each frame has come
  MemoryFeed feed_;
  SurfaceWindow window_;
  Arrivals arrivals_;
  std::size_t heard_ = 0;
  double now_s_ = 0, wanted_s_ = 0, felt_s_ = 0;
  bool begun_ = false;
};

}  // namespace relievo
