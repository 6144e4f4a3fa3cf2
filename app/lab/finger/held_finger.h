// SPDX-License-Identifier: Apache-2.0
// A finger that is held on a moving face, as in the paper's section VI: the force that it feels, tick by tick.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "app/lab/film/film_run.h"
#include "app/lab/finger/hip_path.h"

namespace relievo {

enum class FingerHold : std::uint8_t {
  FixedPoint,   // 5 mm deep on average, wherever the surface moves
  RestingHand,  // pulled to a point 8 mm deep on average, so that it presses 3 mm deep and yields
};

struct HoldPlan {
  static constexpr double kSettleS = 2;  // the finger comes in and comes to rest: not measured
  double from_s = 0;                     // of the film; what is measured begins kSettleS later
  double measured_s = 10;
};

// On `face-nodding`, on the cheek. The ticks of the measured time, with the oracle's answer for the same finger.
[[nodiscard]] std::vector<PlayedTick> holdFinger(const TrueSurface& face, const MemoryFilm& film, TouchMethod& method,
                                                 FingerHold hold, const HoldPlan& plan);
// The same with any source of ticks. `answer` is also called for the ticks before the measured time.
[[nodiscard]] std::vector<PlayedTick> holdFinger(const TrueSurface& face,
                                                 const std::function<PlayedTick(const HipTick&)>& answer,
                                                 FingerHold hold, const HoldPlan& plan);

}  // namespace relievo
