// SPDX-License-Identifier: Apache-2.0
// Kinematics of the Polhem and WoodenHaptics arms: the tip's position, and the motor currents for a force.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "drivers/force/encoder_gate.h"
#include "drivers/polhem/description.h"
#include "platform/realtime.h"

namespace relievo::polhem {

// Bodies: a turns about the vertical axis. b is hinged to a at the shoulder and leans from upright by theta_b. c hangs
// from b's end; its angle theta_c is measured from straight down, relative to the base: a parallelogram makes it
// independent of theta_b. In the maker's frame, z up and x from the base to the user:
//   x = cos tA (Lb sin tB + Lc sin tC), y = sin tA (Lb sin tB + Lc sin tC), z = La + Lb cos tB - Lc cos tC,
// minus the workspace's origin; for variants 0, 1 and 2. Seen from the front, y is to the right, so the device frame of
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
  // The currents, mA, that apply `force_n` to the hand: by virtual work the torque on a body is the dot product of the
  // force and the tip's motion per radian of that body. Exact in every pose, even a singular one.
  [[nodiscard]] glm::dvec3 currentsFor(const glm::dvec3& force_n, const glm::dvec3& theta_rad) const RELIEVO_RT;

  // The strongest force that currents of `milliamps` can apply in every direction, in the middle of the workspace, or
  // in the calibration pose if the arm cannot reach the middle.
  [[nodiscard]] double forceInEveryDirection(double milliamps) const;
  // For the encoder gate: of the joint whose counts are the finest.
  [[nodiscard]] double mmPerCount() const;

 private:
  // Column i: the tip's motion, mm per rad of body i.
  [[nodiscard]] glm::dmat3 jacobian(const glm::dvec3& theta_rad) const RELIEVO_RT;
  [[nodiscard]] glm::dvec3 anglesInTheMiddle() const;

  double shoulder_mm_, upper_mm_, lower_mm_;
  glm::dvec3 origin_mm_;      // of the workspace, in the device frame
  glm::dvec3 rad_per_count_;  // signed by the motor's sense of rotation
  glm::dvec3 ma_per_nmm_;     // likewise
  glm::dvec3 calibration_rad_;
};

}  // namespace relievo::polhem
