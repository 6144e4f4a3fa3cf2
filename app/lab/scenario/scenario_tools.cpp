// SPDX-License-Identifier: Apache-2.0
// Paths of a finger, and figures of a run.
#include "app/lab/scenario/scenario_tools.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace relievo::scenario {

glm::dvec3 Way::at(double t) const {
  const auto after = std::find_if(points_.begin(), points_.end(), [&](const Point& p) { return p.t_s > t; });
  if (after == points_.begin()) return points_.front().at_mm;
  if (after == points_.end()) return points_.back().at_mm;
  const auto before = after - 1;
  return glm::mix(before->at_mm, after->at_mm, (t - before->t_s) / (after->t_s - before->t_s));
}

Relief plane(double z_mm, double slope_x, double slope_y) {
  return [=](double x, double y, double /*t*/) { return z_mm + slope_x * x + slope_y * y; };
}

double ramp(double t, double from, double until) {
  return std::clamp((t - from) / (until - from), 0.0, 1.0);
}

glm::dvec3 normalOf(const Relief& relief, double x, double y, double t) {
  constexpr double kStep = 1e-4;
  const double zx = (relief(x + kStep, y, t) - relief(x - kStep, y, t)) / (2 * kStep);
  const double zy = (relief(x, y + kStep, t) - relief(x, y - kStep, t)) / (2 * kStep);
  return glm::normalize(glm::dvec3(-zx, -zy, 1));
}

// A damped walk along the tangent plane; each step halves what is left on a plane.
glm::dvec3 closestOn(const Relief& relief, const glm::dvec3& hip, double t) {
  glm::dvec3 p = hip;
  for (int i = 0; i < 200; ++i) {
    p.z = relief(p.x, p.y, t);
    const glm::dvec3 n = normalOf(relief, p.x, p.y, t), off = hip - p;
    p += 0.5 * (off - glm::dot(off, n) * n);
  }
  p.z = relief(p.x, p.y, t);
  return p;
}

glm::dvec3 depthOnFlat(const Relief& relief, const glm::dvec3& hip, double t) {
  const glm::dvec3 normal = normalOf(relief, hip.x, hip.y, t);
  return std::max(relief(hip.x, hip.y, t) - hip.z, 0.0) * normal.z * normal;
}

std::span<const StageTick> between(std::span<const StageTick> ticks, double from, double until) {
  const auto place = [&](double t) {
    return std::lower_bound(ticks.begin(), ticks.end(), t, [](const StageTick& a, double b) { return a.t_s < b; });
  };
  return {place(from), place(until)};
}

glm::dvec3 meanForce(std::span<const StageTick> ticks) {
  glm::dvec3 sum(0);
  for (const StageTick& tick : ticks) sum += tick.sent_n;
  return sum / static_cast<double>(std::max<std::size_t>(ticks.size(), 1));
}

double peakForce(std::span<const StageTick> ticks) {
  double peak = 0;
  for (const StageTick& tick : ticks) peak = std::max(peak, glm::length(tick.sent_n));
  return peak;
}

double percentOff(const glm::dvec3& measured, const glm::dvec3& truth) {
  return 100 * glm::distance(measured, truth) / glm::length(truth);
}

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
  const double cosine = glm::dot(a, b) / (glm::length(a) * glm::length(b));
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

constexpr double kFelt = 0.3;  // share of the force straight up above which the surface counts as felt

double longestLostMs(std::span<const StageTick> ticks, const Relief& relief, double deep, double stiffness) {
  double longest = 0, since = -1;
  for (const StageTick& tick : ticks) {
    const glm::dvec3& p = tick.hip_mm;
    const double below = relief(p.x, p.y, toSeconds(tick.media)) - p.z;
    // Not written as "less than", so that NaN counts as not felt.
    const bool felt = tick.asked.contact && glm::length(tick.asked.force_n) >= kFelt * stiffness * below;
    if (!tick.exchanged || felt || !(below > deep)) {
      since = -1;
      continue;
    }
    if (since < 0) since = tick.t_s;
    longest = std::max(longest, tick.t_s + TouchStage::kTickS - since);
  }
  return 1e3 * longest;
}

}  // namespace relievo::scenario
