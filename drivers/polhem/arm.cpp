// SPDX-License-Identifier: Apache-2.0
// Kinematics by the formula in the header; forces become currents by virtual work.
#include "drivers/polhem/arm.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace relievo::polhem {
namespace {

// Converts a vector from the maker's axes to the device frame.
glm::dvec3 turned(const std::array<double, 3>& v) {
  return {v[1], v[2], v[0]};
}

}  // namespace

Arm::Arm(const Description& d)
    : shoulder_mm_(1e3 * d.length_body[0]),
      upper_mm_(1e3 * d.length_body[1]),
      lower_mm_(1e3 * d.length_body[2]),
      origin_mm_(1e3 * turned(d.workspace_origin)) {
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    // The body's angle per angle of the motor. A motor whose shaft points along the body's axis turns the body
    // backwards, since the cable crosses over.
    const double ratio = (d.motor_and_body_aligned[i] ? -1 : 1) * d.diameter_capstan[i] / d.diameter_body[i];
    rad_per_count_[axis] = ratio * 2 * std::numbers::pi / d.cpr_encoder[i];
    ma_per_nmm_[axis] = ratio / d.torque_constant[i];  // N mm / (N m / A) is mA
  }
  calibration_rad_ = anglesOf(d.calibrate_enc);
}

glm::dvec3 Arm::positionOf(const glm::dvec3& theta_rad) const RELIEVO_RT {
  const double reach = upper_mm_ * std::sin(theta_rad.y) + lower_mm_ * std::sin(theta_rad.z);
  const double height = shoulder_mm_ + upper_mm_ * std::cos(theta_rad.y) - lower_mm_ * std::cos(theta_rad.z);
  return glm::dvec3(std::sin(theta_rad.x) * reach, height, std::cos(theta_rad.x) * reach) - origin_mm_;
}

glm::dmat3 Arm::jacobian(const glm::dvec3& theta_rad) const RELIEVO_RT {
  const double sin_a = std::sin(theta_rad.x), cos_a = std::cos(theta_rad.x);
  const double sin_b = std::sin(theta_rad.y), cos_b = std::cos(theta_rad.y);
  const double sin_c = std::sin(theta_rad.z), cos_c = std::cos(theta_rad.z);
  const double reach = upper_mm_ * sin_b + lower_mm_ * sin_c;
  return {reach * glm::dvec3(cos_a, 0, -sin_a), upper_mm_ * glm::dvec3(sin_a * cos_b, -sin_b, cos_a * cos_b),
          lower_mm_ * glm::dvec3(sin_a * cos_c, sin_c, cos_a * cos_c)};
}

glm::dvec3 Arm::currentsFor(const glm::dvec3& force_n, const glm::dvec3& theta_rad) const RELIEVO_RT {
  return ma_per_nmm_ * (force_n * jacobian(theta_rad));  // a row times the matrix: its transpose times the force
}

// Solves the triangle of shoulder, elbow and tip in the plane of the arm.
glm::dvec3 Arm::anglesInTheMiddle() const {
  const double reach = std::hypot(origin_mm_.x, origin_mm_.z), rise = origin_mm_.y - shoulder_mm_;
  const double span = std::hypot(reach, rise);
  const double cos_shoulder = (upper_mm_ * upper_mm_ + span * span - lower_mm_ * lower_mm_) / (2 * upper_mm_ * span);
  if (!(std::abs(cos_shoulder) < 1)) return calibration_rad_;
  const double upper = std::atan2(reach, rise) - std::acos(cos_shoulder);  // the elbow is above
  const double lower = std::atan2(reach - upper_mm_ * std::sin(upper), upper_mm_ * std::cos(upper) - rise);
  return {std::atan2(origin_mm_.x, origin_mm_.z), upper, lower};
}

double Arm::forceInEveryDirection(double milliamps) const {
  const glm::dmat3 columns = jacobian(anglesInTheMiddle());
  double strongest_n = 1e9;
  for (int i = 0; i < 3; ++i) {
    const double most_nmm = milliamps / std::abs(ma_per_nmm_[i]);
    strongest_n = std::min(strongest_n, most_nmm / std::max(1e-6, glm::length(columns[i])));
  }
  return strongest_n;
}

double Arm::mmPerCount() const {
  const glm::dvec3 levers(std::min(upper_mm_, lower_mm_), upper_mm_, lower_mm_);
  const glm::dvec3 mm_per_count = levers * glm::abs(rad_per_count_);
  return std::min({mm_per_count.x, mm_per_count.y, mm_per_count.z});
}

}  // namespace relievo::polhem
