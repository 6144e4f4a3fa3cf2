// SPDX-License-Identifier: Apache-2.0
// A smooth surface of one width: B-splines in space over a grid's control points, weighted over the frames in time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "app/depth_window/felt_scale.h"
#include "app/haptics/method/control_grid.h"
#include "app/haptics/method/frame_weights.h"
#include "platform/realtime.h"

namespace relievo {

// Height and its derivatives in space at one place and moment; mm, 1, 1/mm.
struct SurfacePoint {
  double z = 0;
  double zx = 0, zy = 0;
  double zxx = 0, zxy = 0, zyy = 0;
};

// The surface of one smoothing width: a view of one moment, prepared in the tick before.
class SurfaceLevel {
 public:
  // Whether the surface keeps the depth's curvature (ControlGrid), or takes the means of blocks as they are.
  enum class Curvature : std::uint8_t { Flattened, Kept };
  SurfaceLevel(double sigma_mm, int most_samples, SpaceLaw space, TimeLaw time, Curvature curvature,
               double steady_mm) noexcept;

  [[nodiscard]] ControlGrid& grid() RELIEVO_RT { return grid_; }
  [[nodiscard]] const ControlGrid& grid() const RELIEVO_RT { return grid_; }

  // Starts a new moment. `since_prepared_s` is its time after the moment given to `prepare`; nullopt if the preparation
  // does not apply. `slots` must live until the next `begin`.
  void begin(const FrameSlots& slots, const FrameMoment& moment, std::optional<double> since_prepared_s) RELIEVO_RT;
  [[nodiscard]] SurfacePoint at(double x_mm, double y_mm) RELIEVO_RT;
  [[nodiscard]] double height(double x_mm, double y_mm) RELIEVO_RT;
  // The height on a single frame: the present one (0) or the next (1).
  [[nodiscard]] SurfacePoint atFrame(std::size_t which, double x_mm, double y_mm) RELIEVO_RT;

  // Prepares for the moment `next` near a place: reads the control points around it and weights them for `next` and for
  // `later`, `step_s` after it.
  void prepare(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next, const FrameMoment& later,
               double step_s) RELIEVO_RT;
  // Reads at most so many blocks around a place of all frames that have a weight; true if all of them have been read.
  bool readAllAhead(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next, int most) RELIEVO_RT;
  // Reads a little of the frame that follows those that have a weight at `next`, so that its points need not all be
  // read in the tick in which it gets one.
  void readAhead(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next) RELIEVO_RT;
  // Prefetches everything except the control points, which are the largest part.
  void prefetch() const RELIEVO_RT;

 private:
  struct Cell {
    int i = 0, j = 0;    // of the first of the 4 x 4 control points
    float a = 0, b = 0;  // position within the cell
  };
  [[nodiscard]] Cell cellOf(double x_mm, double y_mm) const RELIEVO_RT;
  // The control points around a cell, and the index of that cell.
  struct CellPatch {
    Patch points{};
    int i = 0, j = 0;
    bool valid = false;  // at this moment
    [[nodiscard]] bool isOf(const Cell& cell) const RELIEVO_RT { return valid && cell.i == i && cell.j == j; }
  };
  [[nodiscard]] const Patch& patchAt(const Cell& cell) RELIEVO_RT;
  [[nodiscard]] SurfacePoint pointOn(const Patch& patch, const Cell& cell) const RELIEVO_RT;
  void weigh(const FrameSlots& slots, const FrameMoment& moment, const FrameMoment& later,
             WeighedFrames& out) const RELIEVO_RT;
  // The points so weighted; carried forward if the window says so.
  void blend(const FrameSlots& slots, const WeighedFrames& weighed, const Cell& cell, Patch& out) RELIEVO_RT;
  void addWhereUnsteady(const WeighedFrames& weighed, const Cell& cell, Patch& out) const RELIEVO_RT;
  void addWhereUnsteady(const Patch& added, Patch& out) const RELIEVO_RT;
  void blendBoth(const FrameSlots& slots, const FrameMoment& later, const Cell& cell, Patch& then) RELIEVO_RT;
  void readLacking(const FrameSlots& slots, const FrameMoment& moment, const Cell& cell) RELIEVO_RT;

  ControlGrid grid_;
  TimeLaw time_;
  float steady_mm_;
  bool cubic_;

  const FrameSlots* slots_ = nullptr;
  FrameMoment moment_;
  WeighedFrames weighed_;
  bool is_weighed_ = false;  // for `moment_`: done on first use
  CellPatch patch_;
  std::array<CellPatch, 2> frame_patch_;  // of the present frame and of the next one

  Patch prepared_{}, prepared_rate_{};  // mm, mm/s
  int prepared_i_ = 0, prepared_j_ = 0;
  std::optional<float> since_prepared_s_;
};

}  // namespace relievo
