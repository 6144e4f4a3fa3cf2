// SPDX-License-Identifier: Apache-2.0
// Newton's method with the full second derivatives, held to descent by a line search (Nocedal and Wright, Numerical
// Optimization, 3.4: the Hessian's eigenvalues are made positive where they are not).
#include "app/lab/truth/slide_to_closest.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace relievo {
namespace {

constexpr double kLongestStepMm = 0.1;   // short enough not to jump over a rise in distance into another hollow
constexpr double kTrustedStepMm = 1e-5;  // this near to a minimum, the rounding of the distance hides the descent
constexpr double kRoundingMm = 1e-11;    // smaller steps that no longer shrink are rounding
constexpr double kLeastCurvature = 1e-3;
constexpr double kSaddleKickMm = 1e-3;
constexpr int kMostSteps = 10000;  // a slide over the whole picture takes 2000

// Half the squared distance as a function of (x, y), to the second order.
struct Distance {
  double value = 0;
  glm::dvec2 slope{0};
  double xx = 0, xy = 0, yy = 0;

  Distance(const TrueSurface& surface, double t, const glm::dvec3& point, const glm::dvec2& at) {
    const SurfaceJet s = surface.jet(at.x, at.y, t);
    const glm::dvec3 d(at.x - point.x, at.y - point.y, s.z - point.z);
    value = 0.5 * glm::dot(d, d);
    slope = {d.x + d.z * s.zx, d.y + d.z * s.zy};
    xx = 1 + s.zx * s.zx + d.z * s.zxx;
    xy = s.zx * s.zy + d.z * s.zxy;
    yy = 1 + s.zy * s.zy + d.z * s.zyy;
  }
};

struct Eigen {
  double low = 0, high = 0;
  glm::dvec2 low_axis{1, 0}, high_axis{0, 1};

  explicit Eigen(const Distance& d) {
    const double mean = 0.5 * (d.xx + d.yy), half = 0.5 * (d.xx - d.yy), spread = std::hypot(half, d.xy);
    low = mean - spread;
    high = mean + spread;
    const double angle = 0.5 * std::atan2(d.xy, half);
    high_axis = {std::cos(angle), std::sin(angle)};
    low_axis = {-high_axis.y, high_axis.x};
  }
};

struct Step {
  glm::dvec2 way{0};
  bool convex = true;  // the full Newton step, towards a minimum
};

Step newtonStep(const Distance& d) {
  const double det = d.xx * d.yy - d.xy * d.xy;
  if (d.xx + d.yy > 0 && det > kLeastCurvature * (d.xx + d.yy)) {
    return {{-(d.yy * d.slope.x - d.xy * d.slope.y) / det, -(d.xx * d.slope.y - d.xy * d.slope.x) / det}, true};
  }
  const Eigen e(d);
  const double along_low = glm::dot(d.slope, e.low_axis), along_high = glm::dot(d.slope, e.high_axis);
  Step step;
  step.convex = e.low > 0;
  step.way = -e.low_axis * (along_low / std::max(std::abs(e.low), kLeastCurvature)) -
             e.high_axis * (along_high / std::max(std::abs(e.high), kLeastCurvature));
  if (!step.convex && glm::length(step.way) < kSaddleKickMm) {
    step.way = e.low_axis * (along_low > 0 ? -kSaddleKickMm : kSaddleKickMm);
  }
  return step;
}

}  // namespace

glm::dvec2 slideToClosest(const TrueSurface& surface, double t_s, const glm::dvec3& point_mm, const glm::dvec2& from_mm,
                          double tolerance_mm) {
  glm::dvec2 at = from_mm;
  Distance here(surface, t_s, point_mm, at);
  double last_length = kLongestStepMm;
  for (int i = 0; i < kMostSteps; ++i) {
    Step step = newtonStep(here);
    const double length = glm::length(step.way);
    if (step.convex && length < kTrustedStepMm) {
      const bool rounding = length < kRoundingMm && length > 0.5 * last_length;
      if (rounding) return at;
      at += step.way;
      if (length < tolerance_mm) return at;
      last_length = length;
      here = Distance(surface, t_s, point_mm, at);
      continue;
    }
    if (length > kLongestStepMm) step.way *= kLongestStepMm / length;
    for (;;) {
      const Distance there(surface, t_s, point_mm, at + step.way);
      constexpr double kEnough = 1e-4;  // of the descent that the slope promises (Armijo)
      if (there.value <= here.value + kEnough * glm::dot(here.slope, step.way)) {
        at += step.way;
        here = there;
        break;
      }
      step.way *= 0.5;
      if (glm::length(step.way) < tolerance_mm) return at;
    }
  }
  return at;
}

}  // namespace relievo
