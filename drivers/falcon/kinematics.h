// SPDX-License-Identifier: Apache-2.0
// Kinematics of the Novint Falcon, a delta robot with three legs: the grip's position, and the torques for a force.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "drivers/force/encoder_gate.h"
#include "platform/realtime.h"

namespace relievo::falcon {

// Frame: x right and y up as seen from the front, z out of the body toward the user, mm. Leg 1 is the top one; 2 and 3
// follow clockwise as seen from the front. theta is the angle of a leg's thigh, rad. Lengths and closure equations are
// those of libnifalcon's measured geometry (BSD licence). libnifalcon's Jacobian and its transposition are wrong (its
// issues 2 and 66): they turn a force by 8.6 to 11.9 degrees on average and by 53 at worst. Here force and torque are
// related by virtual work, which is exact for the given lengths.

// The solver's starting point, the middle of the workspace. The frame's origin is a singular pose.
inline constexpr glm::dvec3 kCentreMm{0, 0, 115};

// Converts encoder counts of the three homed motors to thigh angles: 1280 counts per turn of the motor, a 14.25 mm
// capstan on a 110 mm drum, 35 degrees at the index. One count is 0.64 mrad.
using Counts = EncoderCounts;
[[nodiscard]] glm::dvec3 anglesOf(const Counts& counts) RELIEVO_RT;
inline constexpr double kMmPerCount = 0.0382;  // at the knee
// The nearest counts; for models of the device and for tests.
[[nodiscard]] Counts countsOf(const glm::dvec3& theta_rad) RELIEVO_RT;

struct Pose {
  glm::dvec3 theta_rad{0};
  glm::dmat3 jacobian{0};  // column i is the gradient of theta_i: rad per mm along x, y, z
};
// Closed form. nullopt if the legs cannot reach the position or a leg is singular there.
[[nodiscard]] std::optional<Pose> inverse(const glm::dvec3& position_mm) RELIEVO_RT;

// Newton's method from `near_mm`, at most twelve steps; from the last tick's position two or three suffice. nullopt if
// it does not converge.
[[nodiscard]] std::optional<glm::dvec3> forward(const glm::dvec3& theta_rad, const glm::dvec3& near_mm) RELIEVO_RT;

// The leg torques, N mm, that apply `force_n` to the hand: by virtual work the sum of tau_i grad theta_i is the
// force. Zero in a singular pose.
[[nodiscard]] glm::dvec3 torquesOf(const glm::dvec3& force_n, const Pose& pose) RELIEVO_RT;

}  // namespace relievo::falcon
