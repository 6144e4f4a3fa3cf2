// SPDX-License-Identifier: Apache-2.0
// Geometry of the Novint Falcon: three legs of a delta robot. Where the grip is, and which torques push it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "drivers/usb/encoder_gate.h"
#include "platform/realtime.h"

namespace relievo::falcon {

// Frame: x right and y up as seen from the front, z out of the body toward the user, mm. The legs are numbered 1, 2, 3
// = top, then clockwise as seen from the front; theta is the angle of a leg's thigh, rad. Lengths and closure are
// those of libnifalcon's measured geometry (BSD licence); its own Jacobian and its transposition are wrong (its issues
// 2 and 66), which turns a force by 8.6 to 11.9 degrees in the mean and by 53 at worst. Here force and torque are
// related by virtual work, which is exact for the given lengths.

// Where the solver may begin: the middle of the workspace. The frame's origin is a singular pose.
inline constexpr glm::dvec3 kCentreMm{0, 0, 115};

// Encoder counts of the three motors once they are homed, as thigh angles: 1280 counts a turn of the motor, capstan
// 14.25 mm on a 110 mm drum, 35 degrees at the index. One count is 0.64 mrad, 38 um at the knee.
using Counts = EncoderCounts;
[[nodiscard]] glm::dvec3 anglesOf(const Counts& counts) RELIEVO_RT;
// A count is the 38 um, so that the highest acceleration makes 4 in a tick.
inline constexpr int kGateSlack = EncoderGate::kRounding + 4;
// The nearest counts; for models of the device and for tests.
[[nodiscard]] Counts countsOf(const glm::dvec3& theta_rad) RELIEVO_RT;

struct Pose {
  glm::dvec3 theta_rad{0};
  glm::dmat3 jacobian{0};  // column i is the gradient of theta_i: rad per mm along x, y, z
};
// Closed form. Nothing for a position that the legs cannot reach or where a leg is singular.
[[nodiscard]] std::optional<Pose> inverse(const glm::dvec3& position_mm) RELIEVO_RT;

// Newton's method from `near_mm`, at most twelve steps; from the last tick's position two or three are enough. Nothing
// when it does not come to rest.
[[nodiscard]] std::optional<glm::dvec3> forward(const glm::dvec3& theta_rad, const glm::dvec3& near_mm) RELIEVO_RT;

// The leg torques, N mm, that hold `force_n` against the hand: by virtual work the sum of tau_i grad theta_i is the
// force. Zero in a pose without a solution.
[[nodiscard]] glm::dvec3 torquesOf(const glm::dvec3& force_n, const Pose& pose) RELIEVO_RT;

}  // namespace relievo::falcon
