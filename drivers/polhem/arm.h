// SPDX-License-Identifier: Apache-2.0
// Geometry and drives of an arm of the Polhem and WoodenHaptics family: where its tip is, which currents push it.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "drivers/polhem/description.h"
#include "drivers/usb/encoder_gate.h"
#include "platform/realtime.h"

namespace relievo::polhem {

// Bodies: a turns about the vertical axis; on it, at the shoulder, b leans out from upright by theta_b; c hangs from
// b's end, and its own angle, from straight down, is told against the base (a parallelogram), so that theta_b does not
// turn it. In the maker's frame, z up and x from the base to the user:
//   x = cos tA (Lb sin tB + Lc sin tC), y = sin tA (Lb sin tB + Lc sin tC), z = La + Lb cos tB - Lc cos tC,
// less the workspace's origin. Variants 0, 1 and 2. Seen from in front, y is to the right; thus the device's frame of
// the HAL is (x, y, z) = the maker's (y, z, x), in mm: x right, y up, z toward the viewer, origin in the middle of the
// workspace.
class Arm {
 public:
  explicit Arm(const Description& description);

  // Body angles, rad, from the encoders' counts.
  [[nodiscard]] glm::dvec3 anglesOf(const EncoderCounts& counts) const RELIEVO_RT {
    return rad_per_count_ * glm::dvec3(counts[0], counts[1], counts[2]);
  }
  [[nodiscard]] glm::dvec3 positionOf(const glm::dvec3& theta_rad) const RELIEVO_RT;
  // The currents, mA, that hold `force_n` against the hand: by virtual work the torque on a body is the force's
  // component along what the tip does when that body turns. Exact in every pose, also a singular one.
  [[nodiscard]] glm::dvec3 currentsFor(const glm::dvec3& force_n, const glm::dvec3& theta_rad) const RELIEVO_RT;

  // The strongest force that currents of `milliamps` can hold in every direction, in the middle of the workspace; in
  // that pose's place, when the arm does not reach it, in the one in which it is calibrated.
  [[nodiscard]] double forceInEveryDirection(double milliamps) const;
  // For the encoder gate: counts that the highest acceleration makes in a tick.
  [[nodiscard]] int gateSlack() const;

 private:
  // Column i: how the tip moves, mm per rad of body i.
  [[nodiscard]] glm::dmat3 jacobian(const glm::dvec3& theta_rad) const RELIEVO_RT;
  [[nodiscard]] glm::dvec3 anglesInTheMiddle() const;

  double shoulder_mm_, upper_mm_, lower_mm_;
  glm::dvec3 origin_mm_;      // of the workspace, in the device's axes
  glm::dvec3 rad_per_count_;  // with the motor's sense
  glm::dvec3 ma_per_nmm_;     // likewise
  glm::dvec3 calibration_rad_;
};

}  // namespace relievo::polhem
