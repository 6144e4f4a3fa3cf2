// SPDX-License-Identifier: Apache-2.0
// A rendered film in memory, and runs of a touch method through it on virtual time, with the true contact beside it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "app/depth_window/surface_window.h"
#include "app/haptics/method/method.h"
#include "app/lab/film/depth_rendering.h"
#include "app/lab/finger/hip_path.h"
#include "app/lab/truth/oracle.h"
#include "app/lab/truth/true_surface.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

struct DepthKind {
  const char* name = "8-bit";
  int bits = 8;
  double noise_share = 0;  // standard deviation, in share of full scale
  std::optional<int> crf;  // through H.264; 8 bits only
};

// Every frame that a window from `from_s` to `until_s` needs, with its shots marked. The windows are made in advance,
// so that a run only selects the next one between its ticks. Immutable; one film serves any number of runs.
class MemoryFilm {
 public:
  struct Format {
    DepthKind depth;
    int cols = 720, rows = 486;
    double frames_per_s = 30;
  };

  // Rendered on all processors.
  [[nodiscard]] static Result<MemoryFilm> make(const TrueSurface& surface, const Format& format, double from_s,
                                               double until_s);
  // From existing pictures, in the volume of the true surfaces.
  [[nodiscard]] static Result<MemoryFilm> of(std::span<const Frame> pictures, const DepthCalibration& calibration);

  [[nodiscard]] std::span<const TimedSurface> frames() const { return frames_; }
  // The window in which the frame of that index is the present one.
  [[nodiscard]] const SurfaceWindow& windowAt(std::size_t frame) const { return windows_[frame]; }

 private:
  std::vector<TimedSurface> frames_;
  std::vector<SurfaceWindow> windows_;  // one for each frame
};

struct PlayedTick {
  double t_s = 0;
  glm::dvec3 hip_mm{0};
  Touch touch;
  TrueTouch truth;
  // Measured by the monotonic clock, including the cost of reading it. The prefetch before the position is known counts
  // as upkeep.
  Duration update{0}, upkeep{0};
};

// One method on one film, tick by tick, with the player's frames in the window. Times must not go back. `film` and
// `method` must outlive it; the method is reset.
class FilmRun {
 public:
  FilmRun(const MemoryFilm& film, TouchMethod& method);
  // The caller fills in `truth`.
  [[nodiscard]] PlayedTick tick(const HipTick& hip);

 private:
  const MemoryFilm& film_;
  TouchMethod& method_;
  MonotonicClock clock_;
  std::size_t present_ = 0;
};

// The oracle's answers along a path, which begins outside the solid.
[[nodiscard]] std::vector<TrueTouch> truthAlong(const TrueSurface& surface, std::span<const HipTick> path);
// Plays a whole path; `truth` is as long as `path`.
[[nodiscard]] std::vector<PlayedTick> playPath(const MemoryFilm& film, TouchMethod& method,
                                               std::span<const HipTick> path, std::span<const TrueTouch> truth);

}  // namespace relievo
