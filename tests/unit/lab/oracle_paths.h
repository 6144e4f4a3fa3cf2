// SPDX-License-Identifier: Apache-2.0
// Fingers on paths through exactly known surfaces.
#pragma once

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "app/lab/truth/oracle.h"

namespace relievo::test {

inline constexpr double kTick = 0.001;
using Path = std::function<glm::dvec3(double t_s)>;

inline StepWall wallOf(const TrueSurface& s, double t) {
  return s.wallAt(t).value_or(StepWall{});
}

inline glm::dvec3 unitNormal(const TrueSurface& s, double x, double y, double t) {
  const SurfaceJet j = s.jet(x, y, t);
  return glm::normalize(glm::dvec3(-j.zx, -j.zy, 1));
}

// A finger that comes in from 10 mm above within 0.1 s and then wanders `depth` below the surface.
inline Path wandering(const TrueSurface& s, double depth, double reach_mm = 22) {
  return [&s, depth, reach_mm](double t) {
    const double x = reach_mm * std::sin(5.1 * t), y = reach_mm * std::sin(3.7 * t + 0.4);
    const double below = std::min(t / 0.1 * (depth + 10) - 10, depth);
    return glm::dvec3(x, y, s.height(x, y, t)) - below * unitNormal(s, x, y, t);
  };
}

struct Moment {
  double t;
  glm::dvec3 hip;
  TrueTouch touch;
};

inline std::vector<Moment> follow(const TrueSurface& s, const Path& path, double duration_s, double tick_s = kTick) {
  Oracle oracle(s);
  std::vector<Moment> moments;
  const int ticks = static_cast<int>(std::lround(duration_s / tick_s));
  for (int i = 0; i <= ticks; ++i) {
    const double t = i * tick_s;
    moments.push_back({t, path(t), oracle.update(path(t), t)});
  }
  return moments;
}

}  // namespace relievo::test
