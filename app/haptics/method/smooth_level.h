// SPDX-License-Identifier: Apache-2.0
// The felt surface away from edges, smoothed as widely as the place allows.
#pragma once

#include <optional>

#include "app/depth_window/felt_scale.h"
#include "app/haptics/method/surface_level.h"
#include "platform/realtime.h"

namespace relievo {

// W = w + h (b - w): the wide level w follows every curve that a finger feels; the broad level b averages more of the
// depth's steps and noise, and replaces w where it is straight (h = 1). h is a function of the straightness of b's
// control points, a B-spline like the levels, so that W is as smooth as they are. It falls to 0 while a point that is
// not straight still has little weight, since an edge or a hole behind that point must not be felt from so far away.
// Where h is 0 or 1 all around, only one level counts, and only that one is read.
// A view of one moment, prepared in the tick before, like its levels.
class SmoothLevel {
 public:
  // Without a broad level if it is not wider than the wide one.
  explicit SmoothLevel(const FeltScale& scale) noexcept;
  SmoothLevel(const SmoothLevel&) = delete;
  SmoothLevel& operator=(const SmoothLevel&) = delete;

  void setPicture(const HeightField& field) RELIEVO_RT;
  void forgetFrame(int slot) RELIEVO_RT;
  void begin(const FrameSlots& slots, const FrameMoment& moment, std::optional<double> since_prepared_s) RELIEVO_RT;
  [[nodiscard]] SurfacePoint at(double x_mm, double y_mm) RELIEVO_RT;
  [[nodiscard]] double height(double x_mm, double y_mm) RELIEVO_RT;

  // As SurfaceLevel's.
  void prepare(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next, const FrameMoment& later,
               double step_s) RELIEVO_RT;
  void readAhead(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next) RELIEVO_RT;
  void prefetch() const RELIEVO_RT;

  // The wide level's blocks are larger than those of `narrow`.
  [[nodiscard]] bool isWiderThan(const ControlGrid& narrow) const RELIEVO_RT;
  [[nodiscard]] std::uint64_t blocksRead() const RELIEVO_RT {
    return wide_.grid().blocksRead() + broad_.grid().blocksRead();
  }

 private:
  ControlGrid::StraightPoints straight_;  // of the broad level's points
  SurfaceLevel wide_, broad_;
  bool has_broad_;
};

}  // namespace relievo
