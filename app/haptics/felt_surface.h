// SPDX-License-Identifier: Apache-2.0
// The relief at the scale that a finger feels: smooth where it is smooth, an edge where there is an edge.
#pragma once

#include <array>
#include <cstdint>

#include "app/haptics/control_grid.h"
#include "app/haptics/parts.h"
#include "app/haptics/surface_window.h"
#include "hal/media_time.h"
#include "platform/realtime.h"

namespace relievo {

// Height and its derivatives in space at one place and moment; mm, 1, 1/mm.
struct SurfacePoint {
  double z = 0;
  double zx = 0, zy = 0;
  double zxx = 0, zxy = 0, zyy = 0;
};

// How wide the surface looks around. The standard deviation of the smoothing is 0.645 x the control points' pitch: a
// box of one pitch under a cubic B-spline (variances 1/12 and 4/12 pitch^2).
struct FeltScale {
  double narrow_mm = 0.28;  // standard deviation: what an edge is seen with
  double wide_mm = 0.72;    // what all else is seen with; not wider than narrow: one level is enough
  double clamp_mm = 0.25;   // how far the wide level may leave the narrow one
  TimeLaw narrow_time = TimeLaw::Linear;
  TimeLaw wide_time = TimeLaw::Fitted;
  SpaceLaw space = SpaceLaw::BSpline;  // Quadratic or BSpline
};

// S = N + c(W - N): N sees edges, W is calm, and c is a soft clamp, so that W may correct N's noise but not round an
// edge off by more than `clamp_mm`. Monotone: c never turns back, or a lip would be left at an edge.
// A view for one moment of one window; reads depth where it is asked for.
class FeltSurface {
 public:
  explicit FeltSurface(const FeltScale& scale) noexcept;

  // False: there is no frame. Not later than the next call, every frame that was in the window may be gone.
  bool moment(const SurfaceWindow& window, MediaTime now) RELIEVO_RT;
  void forget() RELIEVO_RT;

  [[nodiscard]] SurfacePoint at(double x_mm, double y_mm) RELIEVO_RT;
  [[nodiscard]] double height(double x_mm, double y_mm) RELIEVO_RT { return at(x_mm, y_mm).z; }

  // Half the narrow pitch: a path sampled so closely sees every crest that the surface has.
  [[nodiscard]] double sampleMm() const RELIEVO_RT { return sample_mm_; }
  [[nodiscard]] std::uint32_t shot() const RELIEVO_RT { return shot_; }
  [[nodiscard]] double volumeDepthMm() const RELIEVO_RT { return depth_mm_; }

  // Reads ahead, after `moment`: the points around a place where the finger will be, and of them at most `points` in
  // the frames that have not begun to count yet.
  void prepare(double x_mm, double y_mm, int points) RELIEVO_RT;

 private:
  struct Level {
    ControlGrid grid;
    TimeLaw time;
    ControlGrid::Frames frames;
    Patch patch{};  // the last one asked for at this moment
    int i = 0, j = 0;
    bool patched = false;
    Level(double sigma_mm, int most_samples, TimeLaw law) noexcept;
  };
  [[nodiscard]] SurfacePoint at(Level& level, double x_mm, double y_mm) RELIEVO_RT;
  void prepare(Level& level, double x_mm, double y_mm, int points) RELIEVO_RT;
  void placeFrames(const SurfaceWindow& window) RELIEVO_RT;
  void weigh(Level& level, const SurfaceWindow& window, MediaTime now) RELIEVO_RT;

  FeltScale scale_;
  Level narrow_, wide_;
  bool two_levels_;
  bool cubic_;
  double sample_mm_ = 0.2;
  double depth_mm_ = 40;

  // Which frame lies in which slot of the caches.
  std::uint32_t epoch_ = 0, shot_ = 0;
  int cols_ = 0, rows_ = 0;
  std::array<MediaTime, ControlGrid::kFrames> time_of_slot_{};
  std::uint32_t slots_in_use_ = 0;
  std::array<std::uint8_t, ControlGrid::kFrames> slot_{};
  std::array<std::int8_t, ControlGrid::kFrames> frame_of_slot_{};
  MediaTime first_time_, last_time_;
  int count_ = 0;
};

}  // namespace relievo
