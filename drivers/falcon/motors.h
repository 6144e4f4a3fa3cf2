// SPDX-License-Identifier: Apache-2.0
// Converts torques to motor words: scale, saturation that keeps the direction, and the windings' thermal limit.
#pragma once

#include <glm/vec3.hpp>

#include "drivers/falcon/packet.h"
#include "drivers/force/motor_limit.h"

namespace relievo::falcon {

// Counts of a motor word per 1 N m of torque. The maker has not published it; published captures fit 6000 to 10000. The
// default is the low end, since a force that is a third too weak is safe and one that is too strong is not. Measure it
// with a spring scale (`relievo devices calibrate`).
inline constexpr double kDefaultCountsPerNm = 6000;

// The windings' limits are not published: 40 % of the highest word is assumed to be bearable continuously.
inline constexpr double kLastingShare = 0.4;

class Motors {
 public:
  explicit Motors(double counts_per_nm) RELIEVO_RT : counts_per_nmm_(counts_per_nm * 1e-3),
                                                     limit_(kMostWord, kLastingShare) {}

  // `torques_nmm` apply the force to the hand; motor words have the opposite sign. `elapsed_s`: since the last
  // call.
  [[nodiscard]] Words wordsFor(const glm::dvec3& torques_nmm, double elapsed_s) RELIEVO_RT {
    const glm::dvec3 given = limit_.limit(-counts_per_nmm_ * torques_nmm, elapsed_s);
    return {static_cast<std::int16_t>(given.x), static_cast<std::int16_t>(given.y), static_cast<std::int16_t>(given.z)};
  }

 private:
  double counts_per_nmm_;
  MotorLimit limit_;
};

}  // namespace relievo::falcon
