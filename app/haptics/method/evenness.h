// SPDX-License-Identifier: Apache-2.0
// How even the relief is around a place: a crease is not.
#pragma once

#include <cstdint>

#include "app/haptics/method/control_grid.h"
#include "app/haptics/method/surface_level.h"
#include "platform/realtime.h"

namespace relievo {

// A control point of a grid is even (1) up to a difference of `most_mm` of the block means around it, uneven (0) from a
// multiple of that on. Between the four points around a place the evenness goes over smoothly, with two continuous
// derivatives, and in time between the present frame and the next one in proportion.
// - Of a level that gives way at creases (Edges::Even): the fourth differences across, down and of both, which are 0 on
//   every surface of the third order. Edges and holes are no creases: from kLeastEdgeMm on a difference counts less,
//   and from kEdgeMm on and beside a hole the point is even.
// - Of a level for straight places alone (Edges::Uneven): the second differences of the point and the eight around it.
class Evenness {
 public:
  static constexpr float kUneven = 2.5F, kBent = 1.25F, kLeastEdgeMm = 4, kEdgeMm = 8;
  enum class Edges : std::uint8_t { Even, Uneven };
  Evenness(double most_mm, Edges edges) noexcept : most_mm_(static_cast<float>(most_mm)), edges_(edges) {}

  // Discards what was found, in one frame or in all.
  void forget(int slot) RELIEVO_RT {
    if (slot == judged_.present || slot == judged_.next) judged_ = {};
  }
  void forget() RELIEVO_RT { judged_ = {}; }
  // Starts a new moment. `slots` must live until the next one.
  void begin(const FrameSlots& slots, const FrameMoment& moment) RELIEVO_RT;
  // Judges the four points around a place. Reads no block but those that the grid's surface needs there as well.
  void judge(ControlGrid& grid, double x_mm, double y_mm) RELIEVO_RT {
    const double a = grid.a(x_mm) - place_.i, b = grid.b(y_mm) - place_.j;
    if (!(frames_ == judged_ && a >= 0 && a < 1 && b >= 0 && b < 1)) judgeAnew(grid, x_mm, y_mm);
  }
  // At the place judged last: all four points are even, or none of them is at all.
  [[nodiscard]] bool all() const RELIEVO_RT { return all_; }
  [[nodiscard]] bool none() const RELIEVO_RT { return none_; }
  // Of places between the same points: 0 .. 1 and its derivatives.
  [[nodiscard]] SurfacePoint at(const ControlGrid& grid, double x_mm, double y_mm) const RELIEVO_RT;

 private:
  void judgeAnew(ControlGrid& grid, double x_mm, double y_mm) RELIEVO_RT;
  [[nodiscard]] float evennessOf(ControlGrid& grid, int i, int j, const ControlGrid::Frames& one) const RELIEVO_RT;

  float most_mm_;
  Edges edges_;
  struct Place {
    int i = 0, j = 0;
  };
  // The cache slots of the present frame and the next one, at this moment and when the place was judged.
  struct TwoFrames {
    int present = -1, next = -1;
    bool operator==(const TwoFrames&) const = default;
  };
  const FrameSlots* slots_ = nullptr;
  TwoFrames frames_, judged_;
  Place place_;
  Float4 present_{}, next_{};  // of the points (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)
  float share_ = 0;            // of the next frame
  bool all_ = true, none_ = false;
};

}  // namespace relievo
