// SPDX-License-Identifier: Apache-2.0
// Limits three motors' commands: what saturates keeps its direction, what lasts is turned down before a winding burns.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "platform/realtime.h"

namespace relievo {

class MotorLimit {
 public:
  // Commands from -most to most, a whole number; `lasting` of it is what the windings stand for good.
  MotorLimit(double most, double lasting) RELIEVO_RT : most_(most), lasting_(lasting* most) {}

  // Whole numbers. All three are scaled together, so that a force that is too much for one motor keeps its direction.
  // `elapsed_s` since the last call.
  [[nodiscard]] glm::dvec3 limit(const glm::dvec3& wanted, double elapsed_s) RELIEVO_RT {
    const double highest = std::max({std::abs(wanted.x), std::abs(wanted.y), std::abs(wanted.z)});
    const double limit = most();
    const glm::dvec3 given = glm::round(highest > limit ? wanted * (limit / highest) : wanted);
    const double share = std::clamp(elapsed_s / kHeatingS, 0.0, 1.0);
    heat_ += share * (given * given - heat_);
    return given;
  }

  // What the hottest motor still may take. From a mean square (over 20 s, as small windings warm up) of the lasting
  // command on, the limit falls from the highest one to that, so that a load that lasts settles between it and 1.22
  // times it.
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
