// SPDX-License-Identifier: Apache-2.0
// Two lattices of samples, the sums of slope and of change, and a check of the result.
#include "app/haptics/method/edge_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/haptics/method/float4.h"

namespace relievo {
namespace {

constexpr int kHalf = 8, kSide = 2 * kHalf + 1;
constexpr double kHalfMm = 6.0, kPitchMm = kHalfMm / kHalf;
constexpr double kLeastStepMm = 3.0;  // smaller steps count as slopes
// of a sample that the edge has passed; smaller changes are the surface's own motion
constexpr double kLeastChangeMm = 1.5;
constexpr double kLeastWayMm = 0.05;   // smaller displacements are ignored
constexpr double kMostWayMm = 4.0;     // larger displacements leave the lattice
constexpr double kMostLeftOver = 0.5;  // share of the change that the displacement may leave unexplained

using Lattice = std::array<float, static_cast<std::size_t>(kSide) * kSide>;  // row by row, y downward

// The sample columns and rows of the lattice.
struct Places {
  std::array<int, kSide> columns{}, rows{};
  Places(const HeightField& field, double x_mm, double y_mm) RELIEVO_RT {
    const GridMapping& grid = field.grid();
    const auto nearest = [](double place, int size) {
      return std::clamp(static_cast<int>(std::lround(place)), 0, size - 1);
    };
    for (int k = 0; k < kSide; ++k) {
      const double away = (k - kHalf) * kPitchMm;
      columns[static_cast<std::size_t>(k)] = nearest(grid.u(x_mm + away), field.cols());
      rows[static_cast<std::size_t>(k)] = nearest(grid.v(y_mm - away), field.rows());
    }
  }
};

// Reads the lattice; returns the largest step between two neighbours in a row or a column.
float look(const HeightField& field, const Places& places, Lattice& out) RELIEVO_RT {
  float* line = out.data();
  bool holes = false;
  for (const int r : places.rows) {
    holes |= field.readRow(r, places.columns, line);
    line += kSide;
  }
  if (holes) {  // a hole counts as a pit
    const auto pit = static_cast<float>(-field.depthMm());
    for (float& z : out) z = std::isnan(z) ? pit : z;
  }
  static_assert(kSide % 4 == 1, "the differences within a row, and those between rows, are taken four at a time");
  Float4 most{};
  const auto see = [&](std::size_t k, std::size_t before) RELIEVO_RT {
    const Float4 step = load4(&out[k]) - load4(&out[k - before]), size = step > -step ? step : -step;
    most = size > most ? size : most;
  };
  for (std::size_t k = kSide; k < out.size(); k += 4) see(k, kSide);
  for (std::size_t row = 0; row < out.size(); row += kSide) {
    for (std::size_t k = row + 1; k < row + kSide; k += 4) see(k, 1);
  }
  return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
}

float at(const Lattice& f, int i, int j) RELIEVO_RT {
  return f[static_cast<std::size_t>(j) * kSide + static_cast<std::size_t>(i)];
}

// True if a displacement by `way`, in pitches, explains the change. The check shifts by whole pitches and allows for
// the rounding.
bool explains(const glm::dvec2& way, const Lattice& before, const Lattice& after) RELIEVO_RT {
  const double right = std::round(way.x), down = std::round(-way.y);
  const int di = static_cast<int>(right), dj = static_cast<int>(down);
  const double allowed = kMostLeftOver + std::hypot(way.x - right, way.y + down) / std::hypot(way.x, way.y);
  float changed = 0, left_over = 0;
  for (int j = std::max(0, -dj); j < kSide - std::max(0, dj); ++j) {
    for (int i = std::max(0, -di); i < kSide - std::max(0, di); ++i) {
      changed += std::abs(at(after, i, j) - at(before, i, j));
      left_over += std::abs(at(after, i + di, j + dj) - at(before, i, j));
    }
  }
  return left_over <= static_cast<float>(allowed) * changed;
}

}  // namespace

glm::dvec2 edgeMotion(const HeightField& from, const HeightField& to, double x_mm, double y_mm) RELIEVO_RT {
  const glm::dvec2 still(0);
  if (!(std::abs(x_mm) < 1e6 && std::abs(y_mm) < 1e6)) return still;
  Lattice before, after;
  const Places places(from, x_mm, y_mm);
  if (look(from, places, before) < static_cast<float>(kLeastStepMm)) return still;
  static_cast<void>(look(to, places, after));

  double change = 0, sx = 0, sy = 0;
  for (int j = 0; j < kSide; ++j) {
    sx += 0.5 *
          static_cast<double>(at(before, kSide - 1, j) - at(before, 0, j) + at(after, kSide - 1, j) - at(after, 0, j));
  }
  for (int i = 0; i < kSide; ++i) {
    sy += 0.5 *
          static_cast<double>(at(before, i, 0) - at(before, i, kSide - 1) + at(after, i, 0) - at(after, i, kSide - 1));
  }
  for (std::size_t k = 0; k < before.size(); ++k) {
    const auto d = static_cast<double>(after[k] - before[k]);
    if (std::abs(d) > kLeastChangeMm) change += d;
  }
  // Sums over the lattice: slopes are in mm per pitch, so the displacement is in pitches.
  const double slope2 = sx * sx + sy * sy;
  if (slope2 <= 0) return still;
  const glm::dvec2 way = -change / slope2 * glm::dvec2(sx, sy);
  const double way2 = (way.x * way.x + way.y * way.y) * kPitchMm * kPitchMm;
  if (way2 < kLeastWayMm * kLeastWayMm || way2 > kMostWayMm * kMostWayMm) return still;
  return explains(way, before, after) ? way * kPitchMm : still;
}

}  // namespace relievo
