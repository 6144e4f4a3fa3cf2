// SPDX-License-Identifier: Apache-2.0
#include "drivers/gamepad/pad_finger.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace relievo {
namespace {

constexpr double kDead = 0.12;  // of the stick's way: worn sticks rest off their middle
constexpr double kMmPerS = 100, kPushN = 2;
constexpr double kFollowS = 0.01;  // about the time between two reports
constexpr double kSpringNPerMm = 0.1, kDampingNSPerMm = 0.002;
constexpr double kDepthMmPerS = 200;
// Against a surface of 0.5 N/mm the depth settles with a time constant of 3.3 ms, so that this step is stable.
constexpr double kLongestStepS = 0.002;

}  // namespace

glm::dvec3 PadFinger::move(const glm::dvec2& stick, double pull, const glm::dvec3& force_n,
                           double elapsed_s) RELIEVO_RT {
  const glm::dvec2 middle_mm = 0.5 * glm::dvec2(kReachMinMm + kReachMaxMm);
  const glm::dvec2 half_mm = 0.5 * glm::dvec2(kReachMaxMm - kReachMinMm);
  glm::dvec2 free_stick = stick;
  for (int axis = 0; axis < motor_axes_; ++axis) {
    free_stick[axis] = 0;
    const double goal_mm = middle_mm[axis] + half_mm[axis] * stick[axis];
    place_mm_[axis] += (1 - std::exp(-elapsed_s / kFollowS)) * (goal_mm - place_mm_[axis]);
  }
  steer(free_stick, force_n, elapsed_s);
  const double goal_mm = kStartMm.z - pull * (kStartMm.z - kReachMinMm.z);
  const double pushed_n = kSpringNPerMm * (goal_mm - place_mm_.z) + force_n.z;
  const double mm_per_s = std::clamp(pushed_n / kDampingNSPerMm, -kDepthMmPerS, kDepthMmPerS);
  place_mm_.z += mm_per_s * std::min(elapsed_s, kLongestStepS);
  place_mm_ = glm::clamp(place_mm_, kReachMinMm, kReachMaxMm);
  return place_mm_;
}

void PadFinger::steer(glm::dvec2 stick, const glm::dvec3& force_n, double elapsed_s) RELIEVO_RT {
  const double out = glm::length(stick);
  if (out <= kDead) return;
  const double share = std::min((out - kDead) / (1 - kDead), 1.0);
  const glm::dvec2 way = stick / out;
  const double against = std::clamp(1 + glm::dot(glm::dvec2(force_n), way) / kPushN, 0.0, 1.0);
  const glm::dvec2 moved_mm = kMmPerS * share * share * against * elapsed_s * way;  // squared: fine in the middle
  place_mm_.x += moved_mm.x;
  place_mm_.y += moved_mm.y;
}

}  // namespace relievo
