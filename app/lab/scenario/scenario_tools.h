// SPDX-License-Identifier: Apache-2.0
// Shared by the scenarios: paths of a finger, and figures of a run.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <span>
#include <vector>

#include "app/lab/film/made_film.h"
#include "app/lab/finger/touch_stage.h"

namespace relievo::scenario {

// A straight path at constant speed from one point to the next; at rest before the first and after the last.
class Way {
 public:
  struct Point {
    double t_s;
    glm::dvec3 at_mm;
  };
  Way(std::initializer_list<Point> points) : points_(points) {}
  [[nodiscard]] glm::dvec3 at(double t_s) const;
  // As the finger of a TouchStage run.
  [[nodiscard]] std::optional<glm::dvec3> operator()(double t_s, const glm::dvec3& /*held_n*/) const { return at(t_s); }

 private:
  std::vector<Point> points_;
};

// An edge that is slanted to the grid, x = kEdgeSlant y.
inline constexpr double kEdgeSlant = 0.3, kEdgeLength = 1.0440306508910550;  // sqrt(1 + kEdgeSlant^2)
// Distance from it, in the plane.
[[nodiscard]] inline double across(double x_mm, double y_mm) {
  return (x_mm - kEdgeSlant * y_mm) / kEdgeLength;
}

[[nodiscard]] Relief plane(double z_mm, double slope_x, double slope_y);
// Rises linearly from 0 at `from_s` to 1 at `until_s`.
[[nodiscard]] double ramp(double t_s, double from_s, double until_s);
// Outward unit normal.
[[nodiscard]] glm::dvec3 normalOf(const Relief& relief, double x_mm, double y_mm, double t_s);
// The point of a gently curved relief that is closest to the finger.
[[nodiscard]] glm::dvec3 closestOn(const Relief& relief, const glm::dvec3& hip_mm, double t_s);
// The depth, along the normal, of a finger close under a nearly flat place; the force is stiffness times this.
[[nodiscard]] glm::dvec3 depthOnFlat(const Relief& relief, const glm::dvec3& hip_mm, double t_s);

[[nodiscard]] std::span<const StageTick> between(std::span<const StageTick> ticks, double from_s, double until_s);
[[nodiscard]] glm::dvec3 meanForce(std::span<const StageTick> ticks);
[[nodiscard]] double peakForce(std::span<const StageTick> ticks);
// |measured - true|/|true|, in %.
[[nodiscard]] double percentOff(const glm::dvec3& measured, const glm::dvec3& truth);
// NaN if one of them is 0.
[[nodiscard]] double degreesBetween(const glm::dvec3& a, const glm::dvec3& b);
// The longest time, ms, in which the finger is more than `deep_mm` below the relief of that moment and the method has
// no contact or hardly any force.
[[nodiscard]] double longestLostMs(std::span<const StageTick> ticks, const Relief& relief, double deep_mm,
                                   double stiffness_n_per_mm);

}  // namespace relievo::scenario
