// SPDX-License-Identifier: Apache-2.0
// From torques to the words of the motors: scale, saturation that keeps the direction, and what the windings stand.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "drivers/falcon/packet.h"

namespace relievo::falcon {

// How many counts of a motor word make a torque of 1 N m. The maker does not tell; the captures on record fit anything
// between 6000 and 10000. The lower end is the default: a force that is too weak by a third is felt as such, one that
// is too strong is not what was asked to be safe. A spring scale tells (`relievo devices calibrate`).
inline constexpr double kDefaultCountsPerNm = 6000;

class Motors {
 public:
  explicit Motors(double counts_per_nm) RELIEVO_RT : counts_per_nmm_(counts_per_nm * 1e-3) {}

  // `torques_nmm` hold the force against the hand; the motors' words have the other sign. All three are scaled
  // together, so that a force that is too much for one leg keeps its direction. `elapsed_s` since the last call.
  [[nodiscard]] Words wordsFor(const glm::dvec3& torques_nmm, double elapsed_s) RELIEVO_RT {
    const glm::dvec3 wanted = -counts_per_nmm_ * torques_nmm;
    const double highest = std::max({std::abs(wanted.x), std::abs(wanted.y), std::abs(wanted.z)});
    const double limit = mostWord();
    const glm::dvec3 given = glm::round(highest > limit ? wanted * (limit / highest) : wanted);
    const double share = std::clamp(elapsed_s / kHeatingS, 0.0, 1.0);
    heat_ += share * (given * given - heat_);
    return {static_cast<std::int16_t>(given.x), static_cast<std::int16_t>(given.y), static_cast<std::int16_t>(given.z)};
  }

  // What the hottest motor still may take. The windings' limits are not published: a mean square (over 20 s) of 40 %
  // of the highest word is taken for what they stand for good. From there on the limit falls from the highest word to
  // that, so that a load that lasts settles between it and 1.22 times it.
  [[nodiscard]] double mostWord() const RELIEVO_RT {
    constexpr double kLasting = 0.4 * kMostWord;
    const double hottest = std::max({heat_.x, heat_.y, heat_.z}) / (kLasting * kLasting);
    return kLasting + (kMostWord - kLasting) * std::clamp((1.5 - hottest) / 0.5, 0.0, 1.0);
  }

 private:
  static constexpr double kHeatingS = 20;
  double counts_per_nmm_;
  glm::dvec3 heat_{0};  // mean square of the words
};

}  // namespace relievo::falcon
