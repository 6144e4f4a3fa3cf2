// SPDX-License-Identifier: Apache-2.0
// Two laws of the rate: theory below the known rate, what was measured above it.
#include "hal/haptic_rate.h"

#include <cmath>

namespace relievo {
namespace {

constexpr double kLowHz = 250, kHighHz = 40'000;
constexpr double kLowNPerMm = 0.325, kHighNPerMm = 0.904;

}  // namespace

double perceivedOnset(double rate_hz) RELIEVO_RT {
  const double power = std::log(kHighNPerMm / kLowNPerMm) / std::log(kHighHz / kLowHz);
  return kLowNPerMm * std::pow(rate_hz / kLowHz, power);
}

double stiffnessAtRate(double known_n_per_mm, double known_hz, double rate_hz) RELIEVO_RT {
  if (rate_hz == known_hz) return known_n_per_mm;
  const double share = rate_hz < known_hz ? rate_hz / known_hz : perceivedOnset(rate_hz) / perceivedOnset(known_hz);
  return share * known_n_per_mm;
}

}  // namespace relievo
