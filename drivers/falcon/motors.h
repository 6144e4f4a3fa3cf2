// SPDX-License-Identifier: Apache-2.0
// From torques to the words of the motors: scale, saturation that keeps the direction, and what the windings stand.
#pragma once

#include <glm/vec3.hpp>

#include "drivers/falcon/packet.h"
#include "drivers/usb/motor_limit.h"

namespace relievo::falcon {

// How many counts of a motor word make a torque of 1 N m. The maker does not tell; the captures on record fit anything
// between 6000 and 10000. The lower end is the default: a force that is too weak by a third is felt as such, one that
// is too strong is not what was asked to be safe. A spring scale tells (`relievo devices calibrate`).
inline constexpr double kDefaultCountsPerNm = 6000;

// The windings' limits are not published: 40 % of the highest word is taken for what they stand for good.
inline constexpr double kLastingShare = 0.4;

class Motors {
 public:
  explicit Motors(double counts_per_nm) RELIEVO_RT : counts_per_nmm_(counts_per_nm * 1e-3),
                                                     limit_(kMostWord, kLastingShare) {}

  // `torques_nmm` hold the force against the hand; the motors' words have the other sign. `elapsed_s` since the last
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
