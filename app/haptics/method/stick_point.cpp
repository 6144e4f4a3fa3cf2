// SPDX-License-Identifier: Apache-2.0
// Finds the point where the force lies on the cone by the Illinois method, on the way to the closest point.
#include "app/haptics/method/stick_point.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace relievo {
namespace {

constexpr int kMostEvaluations = 6;
constexpr double kOfTheCone = 1e-3;
// On a plane the spring's length is at most the finger's depth/cos of the cone; on a bump it is more, and where the
// closest point has gone to another side of the solid, a multiple.
constexpr double kOtherSide = 1.5;

glm::dvec3 placeOf(const Contact& point, double lowered) RELIEVO_RT {
  return {point.x_mm, point.y_mm, point.surface.z - lowered};
}

// A spring from the finger to a point of the surface.
struct Spring {
  double pressed_mm = 0, aside_mm = 0;  // along the normal at the point, and across it

  Spring(const Contact& point, const glm::dvec3& hip, double lowered) RELIEVO_RT {
    const double zx = point.surface.zx, zy = point.surface.zy;
    const glm::dvec3 pull = placeOf(point, lowered) - hip;
    pressed_mm = (pull.z - zx * pull.x - zy * pull.y) / std::sqrt(1 + zx * zx + zy * zy);
    aside_mm = std::sqrt(std::max(glm::dot(pull, pull) - pressed_mm * pressed_mm, 0.0));
  }
  // How far it reaches out of the cone; negative inside.
  [[nodiscard]] double beyond(double coefficient) const RELIEVO_RT { return aside_mm - coefficient * pressed_mm; }
  [[nodiscard]] double squaredMm() const RELIEVO_RT { return aside_mm * aside_mm + pressed_mm * pressed_mm; }
};

// The surface on the way from one point to another: the cubic through both ends. `lowered` by so much.
class Way {
 public:
  Way(const Contact& from, const Contact& to, const glm::dvec3& hip, double lowered) RELIEVO_RT
      : from_(from),
        to_(to),
        hip_(hip),
        lowered_(lowered),
        dx_(to.x_mm - from.x_mm),
        dy_(to.y_mm - from.y_mm),
        squared_(dx_* dx_ + dy_ * dy_),
        begins_(from.surface.zx* dx_ + from.surface.zy * dy_),
        ends_(to.surface.zx* dx_ + to.surface.zy * dy_) {}

  [[nodiscard]] double squaredMm() const RELIEVO_RT { return squared_; }
  [[nodiscard]] Contact at(double share) const RELIEVO_RT {
    const double rest = 1 - share, rise = to_.surface.z - from_.surface.z;
    const double z =
        from_.surface.z + share * share * (3 - 2 * share) * rise + share * rest * (rest * begins_ - share * ends_);
    const double along = 6 * share * rest * rise + rest * (1 - 3 * share) * begins_ + share * (3 * share - 2) * ends_;
    // Across the way the slope is in between; along it, it is the cubic's.
    const double more = (along - rest * begins_ - share * ends_) / squared_;
    return {from_.x_mm + share * dx_,
            from_.y_mm + share * dy_,
            {.z = z,
             .zx = rest * from_.surface.zx + share * to_.surface.zx + more * dx_,
             .zy = rest * from_.surface.zy + share * to_.surface.zy + more * dy_}};
  }
  [[nodiscard]] Spring springTo(const Contact& point) const RELIEVO_RT { return {point, hip_, lowered_}; }

 private:
  const Contact &from_, &to_;
  const glm::dvec3& hip_;
  double lowered_, dx_, dy_, squared_, begins_, ends_;
};

// The point of the way where the force lies on the cone, or just inside: the way begins outside the cone and ends
// inside.
Contact onTheCone(const Way& way, const Spring& from, const Spring& to, double coefficient) RELIEVO_RT {
  double low = 0, high = 1, f_low = from.beyond(coefficient), f_high = to.beyond(coefficient);
  int kept = 0;  // the end that was kept in the last round: -1 low, 1 high
  Contact inside = way.at(1);
  for (int i = 0; i < kMostEvaluations; ++i) {
    const double share = low + (high - low) * f_low / (f_low - f_high);
    const Contact point = way.at(share);
    const Spring spring = way.springTo(point);
    const double f = spring.beyond(coefficient);
    if (std::abs(f) <= kOfTheCone * coefficient * spring.pressed_mm) return point;
    if (f > 0) {
      low = share;
      f_low = f;
      if (kept == 1) f_high *= 0.5;
      kept = 1;
    } else {
      inside = point;
      high = share;
      f_high = f;
      if (kept == -1) f_low *= 0.5;
      kept = -1;
    }
  }
  return inside;
}

}  // namespace

glm::dvec3 StickPoint::follow(FeltSurface& surface, const Friction& friction, const Contact& closest,
                              const glm::dvec3& hip_mm, double lowered_mm) RELIEVO_RT {
  const bool prepared = std::exchange(prepared_, false) && surface.asPrepared();
  if (!holds_) {
    holds_ = true;
    rested_s_ = kSettleS;
    at_ = closest;
    return placeOf(at_, lowered_mm);
  }
  if (!prepared) at_.surface = surface.at(at_.x_mm, at_.y_mm);
  const Spring spring(at_, hip_mm, lowered_mm), shortest(closest, hip_mm, lowered_mm);
  const double moving = friction.dynamic_coefficient, hold = slides() ? moving : friction.static_coefficient;
  const bool other_side = spring.squaredMm() > kOtherSide * kOtherSide * (1 + hold * hold) * shortest.squaredMm();
  if (spring.beyond(hold) <= 0 && !other_side) {
    rested_s_ = std::min(rested_s_ + tick_s_, kSettleS);
    return placeOf(at_, lowered_mm);
  }
  rested_s_ = 0;
  const Way way(at_, closest, hip_mm, lowered_mm);
  if (other_side || way.squaredMm() == 0 || shortest.beyond(moving) >= 0 || spring.beyond(moving) <= 0) {
    at_ = closest;
    return placeOf(at_, lowered_mm);
  }
  const Contact slid = onTheCone(way, spring, shortest, moving);
  const double dx = slid.x_mm - at_.x_mm, dy = slid.y_mm - at_.y_mm;
  at_ = slid;
  if (dx * dx + dy * dy > surface.sampleMm() * surface.sampleMm()) at_.surface = surface.at(at_.x_mm, at_.y_mm);
  return placeOf(at_, lowered_mm);
}

void StickPoint::prepare(FeltSurface& surface) RELIEVO_RT {
  if (!holds_) return;
  at_.surface = surface.at(at_.x_mm, at_.y_mm);
  prepared_ = true;
}

}  // namespace relievo
