// SPDX-License-Identifier: Apache-2.0
// The hand's motions as sums of sine waves and smooth ramps.
#include "drivers/sim/hand_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relievo {
namespace {

constexpr double kRestS = 0.5, kDownS = 1.2;       // at most 82 mm/s: a gentle contact
constexpr double kAboveMm = 48.0, kAimMm = -12.0;  // surfaces are at most 40 mm high

// Rises smoothly from 0 at t = 0 to 1 at t = length.
double easeIn(double t, double length) RELIEVO_RT {
  const double u = std::clamp(t / length, 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

double wave(double t_s, double period_s) RELIEVO_RT {
  return std::sin(2.0 * std::numbers::pi * t_s / period_s);
}

// `down`: from 0, above every surface, to 1, below every surface.
HandPoint over(double x_mm, double y_mm, double down, double force_limit_n) RELIEVO_RT {
  return {{x_mm, y_mm, kAboveMm + down * (kAimMm - kAboveMm)}, force_limit_n};
}

HandPoint stroke(double t, double reach) RELIEVO_RT {
  constexpr double kUpS = 1.1;
  constexpr double kRoundS = 4.0;  // down, stroke, up: a hand that fell through a surface is soon outside again
  const double in_round = std::fmod(t, kRoundS);
  const double down = easeIn(in_round, kDownS) - easeIn(in_round - (kRoundS - kUpS), kUpS);
  // The first contact is near the middle; if there is a hole, the stroke leaves it within half a second.
  const double share = reach * easeIn(t - kDownS / 2, kDownS);
  // At most 31 and 28 mm/s; the common multiple of both periods is 803 s, so that the path does not repeat before.
  return over(-share * 55.0 * wave(t, 11.0), share * 32.0 * wave(t, 7.3), down, 1.5 + 0.5 * wave(t, 3.1));
}

HandPoint rest(double t, double force_n) RELIEVO_RT {
  return over(0, 0, easeIn(t, kDownS), force_n);
}

HandPoint tap(double t) RELIEVO_RT {
  constexpr double kPeriodS = 1.0, kBlowS = 0.3;  // 0.3 m/s
  const double in_period = std::fmod(t, kPeriodS);
  return over(0, 0, easeIn(in_period, kBlowS) - easeIn(in_period - kPeriodS / 2, kBlowS), 1.5);
}

HandPoint shake(double t) RELIEVO_RT {
  constexpr double kPeriodS = 1.0 / 9, kTremorMm = 0.5;
  HandPoint point = rest(t, 1.5 + 0.75 * wave(t, kPeriodS));
  point.position_mm +=
      kTremorMm * glm::dvec3(wave(t, kPeriodS), wave(t + 0.25 * kPeriodS, kPeriodS), wave(t, kPeriodS));
  return point;
}

}  // namespace

HandPoint moveHand(HandMotion motion, double t_s, double reach) RELIEVO_RT {
  const double t = std::max(t_s - kRestS, 0.0);
  switch (motion) {
    case HandMotion::Stroking:
      return stroke(t, reach);
    case HandMotion::Resting:
      return rest(t, 1.0);
    case HandMotion::Pressing:
      return rest(t, 4.0);
    case HandMotion::Tapping:
      return tap(t);
    case HandMotion::Shaking:
      return shake(t);
  }
  return {};
}

}  // namespace relievo
