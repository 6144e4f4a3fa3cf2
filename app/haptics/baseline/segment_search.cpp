// SPDX-License-Identifier: Apache-2.0
// Over a segment, the relief is linear between the lines of the grid and its diagonals, so only these are examined.
#include "app/haptics/baseline/segment_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relievo {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// One family of parallel grid lines (columns, rows or diagonals), met at steady intervals along the segment.
struct LineFamily {
  double next = kNever;  // the segment's parameter at the next line
  double step = kNever;

  LineFamily(double from, double to) RELIEVO_RT {
    const double delta = to - from;
    if (delta == 0) return;
    step = 1.0 / std::abs(delta);
    const double ahead = delta > 0 ? std::floor(from) + 1.0 - from : from - (std::ceil(from) - 1.0);
    next = ahead * step;
  }
};

// The part of a path that lies over the grid, from 0 to 1; empty, with the end before the beginning, if none does.
struct Stretch {
  double begin = 0, end = 1;
};
void clip(Stretch& way, double from, double delta, double last) RELIEVO_RT {
  if (delta == 0) {
    if (from < 0 || from > last) way.end = -1;
    return;
  }
  const double a = (0 - from) / delta, b = (last - from) / delta;
  way.begin = std::max(way.begin, std::min(a, b));
  way.end = std::min(way.end, std::max(a, b));
}
// Clipped first, so that a finger far away costs no more than one nearby.
Stretch overGrid(double u, double du, double last_u, double v, double dv, double last_v) RELIEVO_RT {
  Stretch way;
  clip(way, u, du, last_u);
  clip(way, v, dv, last_v);
  return way;
}

}  // namespace

std::optional<Crossing> firstCrossing(const SurfaceInTime& surface, const glm::dvec3& from_mm,
                                      const glm::dvec3& to_mm) RELIEVO_RT {
  if (surface.empty()) return std::nullopt;
  const GridMapping& grid = surface.grid();
  const double u0 = grid.u(from_mm.x), v0 = grid.v(from_mm.y), z0 = from_mm.z;
  const double du = grid.u(to_mm.x) - u0, dv = grid.v(to_mm.y) - v0, dz = to_mm.z - z0;
  if (!std::isfinite(du + dv + dz)) return std::nullopt;  // the walk along it would never end

  auto [s, end] = overGrid(u0, du, surface.cols() - 1, v0, dv, surface.rows() - 1);
  if (!(s <= end) || surface.cols() < 2 || surface.rows() < 2) return std::nullopt;

  LineFamily columns(u0, u0 + du), rows(v0, v0 + dv), diagonals(u0 - v0, u0 - v0 + du - dv);
  for (LineFamily* family : {&columns, &rows, &diagonals}) {
    if (family->next < s) family->next += std::ceil((s - family->next) * (1.0 / family->step)) * family->step;
  }
  bool above = false;
  bool continuous = false;  // the piece before this one had a surface
  for (;;) {
    const double stop = std::min({columns.next, rows.next, diagonals.next, end});
    const double middle = 0.5 * (s + stop);
    const auto triangle = GridTriangle::under(u0 + du * middle, v0 + dv * middle, surface.cols(), surface.rows());
    if (triangle) {
      const TrianglePlane plane(surface, *triangle);
      if (plane.hole()) {
        continuous = false;
      } else {
        const double uc = u0 - triangle->c, vr = v0 - triangle->r;
        const double height_at_start = z0 + dz * s - plane.at(uc + du * s, vr + dv * s);
        const double height_at_stop = z0 + dz * stop - plane.at(uc + du * stop, vr + dv * stop);
        // Neighbouring pieces meet at the same height but for rounding: what was above stays above.
        above = (continuous && above) || height_at_start >= 0;
        if (above && height_at_stop < 0) {
          const double drop = std::max(height_at_start, 0.0);
          const double hit = s + (stop - s) * (drop / (drop - height_at_stop));
          const glm::dvec3 point(from_mm.x + (to_mm.x - from_mm.x) * hit, from_mm.y + (to_mm.y - from_mm.y) * hit,
                                 z0 + dz * hit);
          return Crossing{point, *triangle};
        }
        above = height_at_stop >= 0;
        continuous = true;
      }
    }
    if (stop >= end) return std::nullopt;
    for (LineFamily* family : {&columns, &rows, &diagonals}) {
      if (family->next <= stop) family->next += family->step;
    }
    s = stop;
  }
}

}  // namespace relievo
