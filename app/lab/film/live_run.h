// SPDX-License-Identifier: Apache-2.0
// A film as a camera sends it: each frame arrives some time after it was taken, and the surface's age follows from
// that.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/depth_window/look_ahead.h"
#include "app/haptics/method/method.h"
#include "app/lab/film/film_run.h"
#include "app/lab/film/memory_feed.h"

namespace relievo {

// The delay of a camera's frames: evenly distributed from `least` to `least` + 2 `jitter`.
struct CameraDelay {
  Duration least = std::chrono::milliseconds(2);
  Duration jitter = std::chrono::milliseconds(5);
  std::uint64_t seed = 1;
};

// One method on one film, tick by tick from the film's first frame on, on virtual time. `film` and `method` must
// outlive it; the method is reset.
class LiveRun {
 public:
  LiveRun(const MemoryFilm& film, TouchMethod& method, const LookAhead& ahead, const CameraDelay& delay);

  // `hip.t_s` is the present moment; the surface is that of an earlier one (`feltS`). The caller fills in `truth`.
  [[nodiscard]] PlayedTick tick(const HipTick& hip);
  // The moment of the surface that was felt in the last tick. If the awaited frame has not arrived, it is the time of
  // the newest frame, from which the surface was extrapolated.
  [[nodiscard]] double feltS() const { return felt_s_; }

 private:
  void hear(double now_s);
  void steer(double now_s);

  const MemoryFilm& film_;
  TouchMethod& method_;
  LookAhead ahead_;
  std::vector<double> there_s_;  // arrival time of each frame
  MemoryFeed feed_;
  SurfaceWindow window_;
  Arrivals arrivals_;
  std::size_t heard_ = 0;
  double now_s_ = 0, wanted_s_ = 0, felt_s_ = 0;
  bool begun_ = false;
};

}  // namespace relievo
