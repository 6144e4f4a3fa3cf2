// SPDX-License-Identifier: Apache-2.0
// The felt surface away from edges, smoothed as widely as the place allows.
#pragma once

#include <array>
#include <optional>

#include "app/depth_window/felt_scale.h"
#include "app/haptics/method/evenness.h"
#include "app/haptics/method/surface_level.h"
#include "platform/realtime.h"

namespace relievo {

// Up to three levels: the wide one, a narrower middle one for creases, and a broad one, which averages more of the
// depth's steps and noise. Each wider level v replaces the surface f of those below it where its relief is even (h =
// 1): S = f + h (v - f). h is a function of the evenness of v's control points (Evenness).
// Where h is 0 or 1 all around, only one of the two counts. Where it is 0, v is read in the two frames that tell so.
// A view of one moment, prepared in the tick before, like its levels.
class SmoothLevel {
 public:
  // Without a middle level if it is not wider than the narrow level, without a broad one if it is not wider than the
  // wide one.
  explicit SmoothLevel(const FeltScale& scale) noexcept;
  SmoothLevel(const SmoothLevel&) = delete;
  SmoothLevel& operator=(const SmoothLevel&) = delete;

  void setPicture(const HeightField& field) RELIEVO_RT;
  void forgetFrame(int slot) RELIEVO_RT;
  void begin(const FrameSlots& slots, const FrameMoment& moment, std::optional<double> since_prepared_s) RELIEVO_RT;
  [[nodiscard]] SurfacePoint at(double x_mm, double y_mm) RELIEVO_RT { return at(widest_, x_mm, y_mm); }
  [[nodiscard]] double height(double x_mm, double y_mm) RELIEVO_RT { return height(widest_, x_mm, y_mm); }

  // As SurfaceLevel's.
  void prepare(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next, const FrameMoment& later,
               double step_s) RELIEVO_RT;
  void readAhead(const FrameSlots& slots, double x_mm, double y_mm, const FrameMoment& next) RELIEVO_RT;
  void prefetch() const RELIEVO_RT;

  // The wide level's blocks are larger than those of `narrow`.
  [[nodiscard]] bool isWiderThan(const ControlGrid& narrow) const RELIEVO_RT;
  [[nodiscard]] std::uint64_t blocksRead() const RELIEVO_RT;

 private:
  static constexpr std::size_t kMiddle = 0, kWide = 1, kBroad = 2;
  struct Level {
    SurfaceLevel surface;
    Evenness evenness;  // of the surface; not of the narrowest one
    bool prepared = false;
    bool absent = false;  // at this moment: nowhere even, or not read yet
  };
  [[nodiscard]] SurfacePoint at(std::size_t level, double x_mm, double y_mm) RELIEVO_RT;
  [[nodiscard]] double height(std::size_t level, double x_mm, double y_mm) RELIEVO_RT;
  // Of a level that has another one below it; false if that one alone counts.
  [[nodiscard]] bool counts(Level& level, double x_mm, double y_mm) RELIEVO_RT;

  std::array<Level, 3> levels_;
  std::size_t narrowest_, widest_;
};

}  // namespace relievo
