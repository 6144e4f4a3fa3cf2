// SPDX-License-Identifier: Apache-2.0
// Solves each leg in its own frame; the gradients of the three legs form the Jacobian.
#include "drivers/falcon/kinematics.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace relievo::falcon {
namespace {

constexpr double kThighMm = 60.0;          // a
constexpr double kShinMm = 102.5;          // b, the long side of the parallelogram
constexpr double kShinEndsMm = 2 * 11.25;  // d + e
constexpr double kPlatformUMm = 14.43;     // c
constexpr double kPlatformVMm = -25.0;     // f
constexpr double kBaseUMm = 40.0;          // r
constexpr double kBaseVMm = -23.09;        // s
constexpr double kRadPerCount = 2 * std::numbers::pi / 1280 * 14.25 / 110.0;
constexpr double kSingular = 1e-12;  // rad^3/mm^3; in the middle it is 5e-6
constexpr double kIndexRad = 35.0 * std::numbers::pi / 180;

// cos and sin of the angles of the legs about z: 105, -15 and -135 degrees.
constexpr double kCos15 = 0.96592582628906828675, kSin15 = 0.25881904510252076235, kHalfRoot = std::numbers::sqrt2 / 2;
constexpr std::array<std::array<double, 2>, 3> kLegs{{{-kSin15, kCos15}, {kCos15, -kSin15}, {-kHalfRoot, -kHalfRoot}}};

struct Leg {
  double theta = 0;        // of the thigh
  glm::dvec3 gradient{0};  // of theta, in the device's frame
};

std::optional<Leg> solveLeg(const std::array<double, 2>& direction, const glm::dvec3& p) RELIEVO_RT {
  const auto [cosine, sine] = direction;
  const double u = cosine * p.x + sine * p.y - kBaseUMm;
  const double v = -sine * p.x + cosine * p.y - kBaseVMm;
  const double w = p.z;

  // Closure: v + f = b cos t3; u + c = a cos t1 + L cos t2; w = a sin t1 + L sin t2; L = d + e + b sin t3.
  const double cos3 = (v + kPlatformVMm) / kShinMm;
  if (!(std::abs(cos3) < 1)) return std::nullopt;
  const double sin3 = std::sqrt(1 - cos3 * cos3);  // t3 lies in (0, pi)
  const double reach = kShinEndsMm + kShinMm * sin3;
  const double across = u + kPlatformUMm;
  const double span = std::hypot(across, w);
  const double cos_knee = (kThighMm * kThighMm + span * span - reach * reach) / (2 * kThighMm * span);
  if (!(std::abs(cos_knee) < 1)) return std::nullopt;

  Leg leg;
  leg.theta = std::atan2(w, across) - std::acos(cos_knee);
  const double cos2 = (across - kThighMm * std::cos(leg.theta)) / reach;
  const double sin2 = (w - kThighMm * std::sin(leg.theta)) / reach;
  // sin(t2 - t1): zero where shin and thigh are in line, a singular pose.
  const double bend = sin2 * std::cos(leg.theta) - cos2 * std::sin(leg.theta);
  const double denominator = kThighMm * sin3 * bend;
  if (!(std::abs(denominator) > 1e-6 * kThighMm)) return std::nullopt;
  const double gu = sin3 * cos2 / denominator, gv = cos3 / denominator, gw = sin3 * sin2 / denominator;
  leg.gradient = {gu * cosine - gv * sine, gu * sine + gv * cosine, gw};
  return leg;
}

}  // namespace

glm::dvec3 anglesOf(const Counts& counts) RELIEVO_RT {
  return kIndexRad + kRadPerCount * glm::dvec3(counts[0], counts[1], counts[2]);
}

Counts countsOf(const glm::dvec3& theta_rad) RELIEVO_RT {
  Counts counts{};
  for (int i = 0; i < 3; ++i) {
    const double count = std::clamp(std::round((theta_rad[i] - kIndexRad) / kRadPerCount), -32768.0, 32767.0);
    counts[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(count);
  }
  return counts;
}

std::optional<Pose> inverse(const glm::dvec3& position_mm) RELIEVO_RT {
  Pose pose;
  for (int i = 0; i < 3; ++i) {
    const auto leg = solveLeg(kLegs[static_cast<std::size_t>(i)], position_mm);
    if (!leg) return std::nullopt;
    pose.theta_rad[i] = leg->theta;
    pose.jacobian[i] = leg->gradient;
  }
  return pose;
}

std::optional<glm::dvec3> forward(const glm::dvec3& theta_rad, const glm::dvec3& near_mm) RELIEVO_RT {
  constexpr int kMostSteps = 12;
  constexpr double kAtRestMm = 1e-6, kLongestStepMm = 30;
  glm::dvec3 p = near_mm;
  for (int i = 0; i < kMostSteps; ++i) {
    const auto pose = inverse(p);
    if (!pose) {  // beyond the legs' reach, a convex region around the centre
      p = 0.5 * (p + kCentreMm);
      continue;
    }
    const glm::dmat3 rows = glm::transpose(pose->jacobian);
    if (!(std::abs(glm::determinant(rows)) > kSingular)) return std::nullopt;
    const glm::dvec3 step = glm::inverse(rows) * (theta_rad - pose->theta_rad);
    const double length = glm::length(step);
    p += length > kLongestStepMm ? step * (kLongestStepMm / length) : step;
    // Newton's method converges quadratically: the error is under a nanometre after a step of a micrometre.
    if (length < 1e3 * kAtRestMm) return p;
  }
  return std::nullopt;
}

glm::dvec3 torquesOf(const glm::dvec3& force_n, const Pose& pose) RELIEVO_RT {
  if (!(std::abs(glm::determinant(pose.jacobian)) > kSingular)) return glm::dvec3(0);
  return glm::inverse(pose.jacobian) * force_n;
}

}  // namespace relievo::falcon
