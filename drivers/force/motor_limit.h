// SPDX-License-Identifier: Apache-2.0
// Limits the commands of three motors: saturation keeps the force's direction, and a lasting load is reduced before a
// winding overheats.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "platform/realtime.h"

namespace relievo {

class MotorLimit {
 public:
  // Commands range from -most to most, a whole number. `lasting`: the fraction of it that the windings can bear
  // continuously.
  MotorLimit(double most, double lasting) RELIEVO_RT : most_(most), lasting_(lasting* most) {}

  // Returns whole numbers. All three are scaled together, so that a force that exceeds one motor's limit keeps its
  // direction. `elapsed_s`: since the last call.
  [[nodiscard]] glm::dvec3 limit(const glm::dvec3& wanted, double elapsed_s) RELIEVO_RT {
    const double highest = std::max({std::abs(wanted.x), std::abs(wanted.y), std::abs(wanted.z)});
    const double limit = most();
    const glm::dvec3 given = glm::round(highest > limit ? wanted * (limit / highest) : wanted);
    const double share = std::clamp(elapsed_s / kHeatingS, 0.0, 1.0);
    heat_ += share * (given * given - heat_);
    return given;
  }

  // The limit for the hottest motor. The heat is the mean square of the commands over 20 s, the time in which small
  // windings warm up. Between 1 and 1.5 times the lasting command's square the limit falls from the highest command to
  // the lasting one, so that a lasting load settles at 1 to 1.22 times the lasting command.
  [[nodiscard]] double most() const RELIEVO_RT {
    const double hottest = std::max({heat_.x, heat_.y, heat_.z}) / (lasting_ * lasting_);
    return lasting_ + (most_ - lasting_) * std::clamp((1.5 - hottest) / 0.5, 0.0, 1.0);
  }

 private:
  static constexpr double kHeatingS = 20;
  double most_, lasting_;
  glm::dvec3 heat_{0};  // mean square of the commands
};

}  // namespace relievo
