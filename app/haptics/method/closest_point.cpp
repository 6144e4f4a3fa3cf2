// SPDX-License-Identifier: Apache-2.0
// Newton's method on half the squared distance, including the surface's curvature, with limited steps.
#include "app/haptics/method/closest_point.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "platform/prefetch.h"

namespace relievo {
namespace {

constexpr int kMostEvaluations = 10;
constexpr double kSettledMm = 1e-4;
// A step shorter than the first is taken on the second-order Taylor polynomial, without evaluating the surface at its
// end; one shorter than the second is the last.
constexpr double kTaylorMm = 0.03, kTaylorEndMm = 0.01;

// Gradient and Hessian of half the squared distance over (x, y).
struct Distance {
  double half_squared, gx, gy, hxx, hxy, hyy;

  Distance(const Contact& c, const glm::dvec3& hip, double lowered) RELIEVO_RT {
    const SurfacePoint& s = c.surface;
    const double dx = c.x_mm - hip.x, dy = c.y_mm - hip.y, e = s.z - lowered - hip.z;
    half_squared = 0.5 * (dx * dx + dy * dy + e * e);
    gx = dx + e * s.zx;
    gy = dy + e * s.zy;
    hxx = 1 + s.zx * s.zx + e * s.zxx;
    hxy = s.zx * s.zy + e * s.zxy;
    hyy = 1 + s.zy * s.zy + e * s.zyy;
    // If the finger is deeper than the radius of curvature, the Hessian is not positive definite; without the curvature
    // term it is.
    const double least = 0.05;
    if (hxx + hyy <= least || hxx * hyy - hxy * hxy <= least * (hxx + hyy)) {
      hxx = 1 + s.zx * s.zx;
      hxy = s.zx * s.zy;
      hyy = 1 + s.zy * s.zy;
    }
  }
  // Solves H step = (bx, by).
  [[nodiscard]] glm::dvec2 solve(double bx, double by) const RELIEVO_RT {
    const double d = 1 / (hxx * hyy - hxy * hxy);
    return {(hyy * bx - hxy * by) * d, (hxx * by - hxy * bx) * d};
  }
};

double squared(const glm::dvec2& v) RELIEVO_RT {
  return v.x * v.x + v.y * v.y;
}

void taylorStep(Contact& c, const glm::dvec2& step) RELIEVO_RT {
  SurfacePoint& s = c.surface;
  const double bx = s.zxx * step.x + s.zxy * step.y, by = s.zxy * step.x + s.zyy * step.y;
  s.z += (s.zx + 0.5 * bx) * step.x + (s.zy + 0.5 * by) * step.y;
  s.zx += bx;
  s.zy += by;
  c.x_mm += step.x;
  c.y_mm += step.y;
}

}  // namespace

RELIEVO_TICK_CODE Contact closestPoint(FeltSurface& surface, double x_mm, double y_mm, const glm::dvec3& hip_mm,
                                       double lowered_mm, SlideUntil until) RELIEVO_RT {
  Contact best{x_mm, y_mm, surface.at(x_mm, y_mm), false};
  Distance distance(best, hip_mm, lowered_mm);
  double scale = 1;
  for (int evaluation = 1;; ++evaluation) {
    glm::dvec2 step = scale * distance.solve(-distance.gx, -distance.gy);
    const double size2 = squared(step);
    const bool last = evaluation >= kMostEvaluations || (until == SlideUntil::MuchRead && surface.hasReadMuch());
    if (size2 < kTaylorMm * kTaylorMm && scale == 1) {
      taylorStep(best, step);
      best.settled = size2 < kTaylorEndMm * kTaylorEndMm;
      if (best.settled || last) return best;
      best.surface = surface.at(best.x_mm, best.y_mm);
      distance = Distance(best, hip_mm, lowered_mm);
      continue;
    }
    best.settled = size2 < kSettledMm * kSettledMm;
    if (best.settled || last) return best;
    const double slope = std::hypot(best.surface.zx, best.surface.zy);
    const double longest = 3 * surface.sampleMm() / std::max(1.0, slope / kWallSlope);
    if (size2 > longest * longest) step *= longest / std::sqrt(size2);
    Contact next{best.x_mm + step.x, best.y_mm + step.y, {}, false};
    next.surface = surface.at(next.x_mm, next.y_mm);
    const Distance there(next, hip_mm, lowered_mm);
    if (there.half_squared < distance.half_squared) {
      best = next;
      distance = there;
      scale = 1;
    } else {
      scale *= 0.35;
    }
  }
}

RELIEVO_TICK_CODE glm::dvec2 predictedStep(const Contact& contact, const glm::dvec3& hip_mm, const glm::dvec3& moved_mm,
                                           double lowered_mm) RELIEVO_RT {
  // For a finger 5 mm inside a sphere of radius 6 mm, the closest point moves six times as far as the finger. Beyond
  // this factor the local curvature does not describe places that far away.
  constexpr double kMost = 8;
  const Distance d(contact, hip_mm, lowered_mm);
  const SurfacePoint& s = contact.surface;
  const glm::dvec2 step = d.solve(moved_mm.x + s.zx * moved_mm.z, moved_mm.y + s.zy * moved_mm.z);
  const double most2 = kMost * kMost * glm::dot(moved_mm, moved_mm), size2 = squared(step);
  return size2 <= most2 ? step : step * std::sqrt(most2 / size2);
}

}  // namespace relievo
