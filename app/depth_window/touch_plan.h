// SPDX-License-Identifier: Apache-2.0
// Chooses the least smoothing that a clip's depth needs: the plan.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "app/depth_window/clip_measure.h"
#include "app/depth_window/felt_scale.h"
#include "app/depth_window/look_ahead.h"
#include "app/depth_window/surface_window.h"

namespace relievo {

struct TouchPlan {
  ClipMeasure measure;
  FeltScale scale;
  double error = 0;    // expected error of the force, as a share of it
  std::string reason;  // one line
};

// The smoothing with the least expected error for a finger 5 mm deep, and the law of time that suits the noise; of the
// laws that need no frames beyond the look-ahead.
[[nodiscard]] TouchPlan planTouch(const ClipMeasure& measure, const LookAhead& ahead = {});
// The plan for a film that begins with these frames, in ascending order and with shots marked. It is measured on the
// first four frames, which a player has when it begins. Player, probe and laboratory all use this function.
inline constexpr std::size_t kPlanFrames = 4;
[[nodiscard]] TouchPlan planFilm(std::span<const TimedSurface> first_frames, const LookAhead& ahead = {});
// "levels of 0.28 and 1.98 mm, 3.96 where straight, linear and fitted in time"
[[nodiscard]] std::string describe(const FeltScale& scale);

}  // namespace relievo
