// SPDX-License-Identifier: Apache-2.0
// The triangulated relief at one moment, its vertices read from one frame or interpolated between two.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>

#include "app/depth_window/parts.h"
#include "app/depth_window/surface_window.h"
#include "hal/media/media_time.h"
#include "platform/realtime.h"

namespace relievo {

// Whether a method heeds that a frame belongs to another shot. The paper's methods know frames and times alone.
enum class Cuts : std::uint8_t { Heeded, Unknown };

// A view for one tick. Vertices are computed on demand; nothing is built.
class SurfaceInTime {
 public:
  SurfaceInTime() = default;
  // The first and the last frame hold outside the window. Count 0: an empty surface, holes everywhere.
  SurfaceInTime(const SurfaceWindow& window, MediaTime now, TimeLaw law, Cuts cuts = Cuts::Heeded) RELIEVO_RT {
    if (window.count == 0) return;
    int k = window.count - 1;
    while (k > 0 && window.frames[static_cast<std::size_t>(k)].time > now) --k;
    const TimedSurface& present = window.frames[static_cast<std::size_t>(k)];
    present_ = &present.field;
    if (law == TimeLaw::Hold || k + 1 == window.count || now <= present.time) return;
    const TimedSurface& next = window.frames[static_cast<std::size_t>(k) + 1];
    if (next.repeats) return;
    if (cuts == Cuts::Heeded && next.shot != present.shot) return;  // before a cut the old scene stands
    next_ = &next.field;
    // Paper, eq. 1, with the frame period taken from the timestamps.
    weight_ = toSeconds(now - present.time) / toSeconds(next.time - present.time);
  }

  [[nodiscard]] bool empty() const RELIEVO_RT { return present_ == nullptr; }
  [[nodiscard]] int cols() const RELIEVO_RT { return empty() ? 0 : present_->cols(); }
  [[nodiscard]] int rows() const RELIEVO_RT { return empty() ? 0 : present_->rows(); }
  [[nodiscard]] const GridMapping& grid() const RELIEVO_RT { return present_->grid(); }

  // Requires 0 <= c < cols, 0 <= r < rows. NaN at a hole of either frame.
  [[nodiscard]] double vertexHeight(int c, int r) const RELIEVO_RT {
    const double z = present_->heightMm(c, r);
    return next_ == nullptr ? z : z + (next_->heightMm(c, r) - z) * weight_;
  }
  // The same as a point in the scene frame; outside the grid its height is NaN, too.
  [[nodiscard]] glm::dvec3 vertex(int c, int r) const RELIEVO_RT {
    const bool inside = c >= 0 && r >= 0 && c < cols() && r < rows();
    return {grid().x(c), grid().y(r), inside ? vertexHeight(c, r) : HeightField::kHole};
  }

 private:
  const HeightField* present_ = nullptr;
  const HeightField* next_ = nullptr;
  double weight_ = 0;
};

// The triangle of the grid that lies under a point in grid units. A cell is split by its diagonal from (c, r) to
// (c+1, r+1); `right` is the triangle with the corner (c+1, r), the other has (c, r+1).
struct GridTriangle {
  int c = 0, r = 0;
  bool right = false;

  // Nullopt outside the grid, where there is no surface.
  [[nodiscard]] static std::optional<GridTriangle> under(double u, double v, int cols, int rows) RELIEVO_RT {
    if (!(u >= 0 && v >= 0 && u <= cols - 1 && v <= rows - 1) || cols < 2 || rows < 2) return std::nullopt;
    const int c = std::min(static_cast<int>(u), cols - 2);
    const int r = std::min(static_cast<int>(v), rows - 2);
    return GridTriangle{c, r, u - c >= v - r};
  }
};

// The plane of a triangle as heights over grid units: z = z0 + zu (u - c) + zv (v - r).
struct TrianglePlane {
  double z0 = 0, zu = 0, zv = 0;

  TrianglePlane(const SurfaceInTime& surface, const GridTriangle& t) RELIEVO_RT {
    z0 = surface.vertexHeight(t.c, t.r);
    const double across = surface.vertexHeight(t.c + 1, t.r + 1);
    const double corner = t.right ? surface.vertexHeight(t.c + 1, t.r) : surface.vertexHeight(t.c, t.r + 1);
    zu = t.right ? corner - z0 : across - corner;
    zv = t.right ? across - corner : corner - z0;
  }
  [[nodiscard]] bool hole() const RELIEVO_RT { return std::isnan(z0 + zu + zv); }
  [[nodiscard]] double at(double du, double dv) const RELIEVO_RT { return z0 + zu * du + zv * dv; }
};

// The surface's height at (x, y); NaN where there is none. A point on the rim of a hole belongs to the surface: a proxy
// may rest there.
[[nodiscard]] inline double surfaceHeight(const SurfaceInTime& surface, double x_mm, double y_mm) RELIEVO_RT {
  if (surface.empty()) return HeightField::kHole;
  const double u = surface.grid().u(x_mm);
  const double v = surface.grid().v(y_mm);
  const auto heightIn = [&](const std::optional<GridTriangle>& t) {
    return t ? TrianglePlane(surface, *t).at(u - t->c, v - t->r) : HeightField::kHole;
  };
  double height = heightIn(GridTriangle::under(u, v, surface.cols(), surface.rows()));
  // Steps in eight directions reach every triangle that may share an edge or a vertex here.
  constexpr double kNear = 1e-9, kNearer = 0.4e-9;
  constexpr std::array<std::pair<double, double>, 8> kAround{{{kNear, kNearer},
                                                              {kNearer, kNear},
                                                              {-kNearer, kNear},
                                                              {-kNear, kNearer},
                                                              {-kNear, -kNearer},
                                                              {-kNearer, -kNear},
                                                              {kNearer, -kNear},
                                                              {kNear, -kNearer}}};
  for (std::size_t i = 0; i < kAround.size() && std::isnan(height); ++i) {
    const auto& [du, dv] = kAround[i];
    height = heightIn(GridTriangle::under(u + du, v + dv, surface.cols(), surface.rows()));
  }
  return height;
}

}  // namespace relievo
