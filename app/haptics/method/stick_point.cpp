// SPDX-License-Identifier: Apache-2.0
// Finds the point where the force lies on the cone by the Illinois method, on the way to the closest point.
#include "app/haptics/method/stick_point.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace relievo {
namespace {

constexpr int kMostEvaluations = 6;
constexpr double kOfTheCone = 1e-3;
// On a plane the spring's length is at most the finger's depth/cos of the cone; on a bump it is more, and where the
// closest point has gone to another side of the solid, a multiple.
constexpr double kOtherSide = 1.5;

// A spring from the finger to a point of the surface.
struct Spring {
  glm::dvec3 place{0};
  double pressed_mm = 0, aside_mm = 0;  // along the normal at the point, and across it

  Spring(const glm::dvec3& point, double zx, double zy, const glm::dvec3& hip) RELIEVO_RT : place(point) {
    const glm::dvec3 normal = glm::dvec3(-zx, -zy, 1) / std::sqrt(1 + zx * zx + zy * zy);
    const glm::dvec3 pull = point - hip;
    pressed_mm = glm::dot(pull, normal);
    aside_mm = glm::length(pull - pressed_mm * normal);
  }
  // How far it reaches out of the cone; negative inside.
  [[nodiscard]] double beyond(double coefficient) const RELIEVO_RT { return aside_mm - coefficient * pressed_mm; }
  [[nodiscard]] double squaredMm() const RELIEVO_RT { return aside_mm * aside_mm + pressed_mm * pressed_mm; }
};

Spring springTo(FeltSurface& surface, double x, double y, const glm::dvec3& hip, double lowered) RELIEVO_RT {
  const SurfacePoint s = surface.at(x, y);
  return {{x, y, s.z - lowered}, s.zx, s.zy, hip};
}

// The point between `from`, outside the cone, and `to`, inside, where the force lies on it, or just inside.
Spring onTheCone(FeltSurface& surface, const Spring& from, const Spring& to, double coefficient, const glm::dvec3& hip,
                 double lowered) RELIEVO_RT {
  Spring inside = to;
  double low = 0, high = 1, f_low = from.beyond(coefficient), f_high = to.beyond(coefficient);
  int kept = 0;  // the end that was kept in the last round: -1 low, 1 high
  for (int i = 0; i < kMostEvaluations; ++i) {
    const double share = low + (high - low) * f_low / (f_low - f_high);
    const double x = from.place.x + share * (to.place.x - from.place.x);
    const double y = from.place.y + share * (to.place.y - from.place.y);
    const Spring spring = springTo(surface, x, y, hip, lowered);
    const double f = spring.beyond(coefficient);
    if (std::abs(f) <= kOfTheCone * coefficient * spring.pressed_mm) return spring;
    if (f > 0) {
      low = share;
      f_low = f;
      if (kept == 1) f_high *= 0.5;
      kept = 1;
    } else {
      inside = spring;
      high = share;
      f_high = f;
      if (kept == -1) f_low *= 0.5;
      kept = -1;
    }
  }
  return inside;
}

}  // namespace

glm::dvec3 StickPoint::follow(FeltSurface& surface, const Contact& closest, const glm::dvec3& hip_mm,
                              double lowered_mm) RELIEVO_RT {
  const glm::dvec3 close(closest.x_mm, closest.y_mm, closest.surface.z - lowered_mm);
  if (!holds_) {
    holds_ = true;
    rested_s_ = kSettleS;
    x_mm_ = close.x;
    y_mm_ = close.y;
    return close;
  }
  Spring spring = springTo(surface, x_mm_, y_mm_, hip_mm, lowered_mm);
  const Spring shortest(close, closest.surface.zx, closest.surface.zy, hip_mm);
  const double hold = slides() ? friction_.dynamic_coefficient : friction_.static_coefficient;
  const bool other_side = spring.squaredMm() > kOtherSide * kOtherSide * (1 + hold * hold) * shortest.squaredMm();
  if (spring.beyond(hold) <= 0 && !other_side) {
    rested_s_ = std::min(rested_s_ + tick_s_, kSettleS);
    return spring.place;
  }
  rested_s_ = 0;
  const bool brackets = !other_side && shortest.beyond(friction_.dynamic_coefficient) < 0;
  spring =
      brackets ? onTheCone(surface, spring, shortest, friction_.dynamic_coefficient, hip_mm, lowered_mm) : shortest;
  x_mm_ = spring.place.x;
  y_mm_ = spring.place.y;
  return spring.place;
}

}  // namespace relievo
