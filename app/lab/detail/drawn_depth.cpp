// SPDX-License-Identifier: Apache-2.0
// All corners are samples, so the samples that a triangle covers are found in whole numbers.
#include "app/lab/detail/drawn_depth.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "app/lab/detail/uniform_grid.h"
#include "app/render/relief/relief_triangles.h"

namespace relievo {
namespace {

struct Corner {
  int c, r;
  double z;
};

class Heights {
 public:
  explicit Heights(const HeightField& field) : cols_(field.cols()), rows_(field.rows()), z_(own(field)) {}

  // In any order of the corners.
  void cover(const Corner& a, Corner b, Corner d) {
    int twice_area = (b.c - a.c) * (d.r - a.r) - (b.r - a.r) * (d.c - a.c);
    if (twice_area == 0) return;
    if (twice_area < 0) {
      std::swap(b, d);
      twice_area = -twice_area;
    }
    const auto side = [](const Corner& from, const Corner& to, int c, int r) {
      return (to.c - from.c) * (r - from.r) - (to.r - from.r) * (c - from.c);
    };
    for (int r = std::min({a.r, b.r, d.r}); r <= std::max({a.r, b.r, d.r}); ++r) {
      for (int c = std::min({a.c, b.c, d.c}); c <= std::max({a.c, b.c, d.c}); ++c) {
        const int of_a = side(b, d, c, r), of_b = side(d, a, c, r), of_d = side(a, b, c, r);
        if (of_a < 0 || of_b < 0 || of_d < 0) continue;
        z_[static_cast<std::size_t>(r) * cols_ + c] = (of_a * a.z + of_b * b.z + of_d * d.z) / twice_area;
      }
    }
  }

  [[nodiscard]] Frame frame(double depth_mm) const {
    const auto codes = std::make_shared<std::vector<std::uint16_t>>();
    codes->reserve(z_.size());
    for (const double z : z_) {
      codes->push_back(static_cast<std::uint16_t>(std::lround(std::clamp(z / depth_mm, 0.0, 1.0) * 65535)));
    }
    return grayFrame(codes, cols_, rows_);
  }

 private:
  static std::vector<double> own(const HeightField& field) {
    std::vector<double> heights;
    for (int r = 0; r < field.rows(); ++r) {
      for (int c = 0; c < field.cols(); ++c) heights.push_back(field.heightMm(c, r));
    }
    return heights;
  }

  int cols_, rows_;
  std::vector<double> z_;
};

std::vector<int> samplesOf(int samples, int step) {
  std::vector<int> kept(UniformGrid::verticesAlong(samples, step));
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = std::min(static_cast<int>(i) * step, samples - 1);
  return kept;
}

// Of all samples it is the depth itself.
std::size_t coverGrid(const HeightField& field, int step, Heights& heights) {
  if (step == 1) return std::size_t{2} * (field.cols() - 1) * (field.rows() - 1);
  const std::vector<int> columns = samplesOf(field.cols(), step), rows = samplesOf(field.rows(), step);
  const auto corner = [&](std::size_t i, std::size_t j) {
    return Corner{columns[i], rows[j], field.heightMm(columns[i], rows[j])};
  };
  for (std::size_t j = 0; j + 1 < rows.size(); ++j) {
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
      heights.cover(corner(i, j), corner(i, j + 1), corner(i + 1, j + 1));
      heights.cover(corner(i, j), corner(i + 1, j + 1), corner(i + 1, j));
    }
  }
  return 2 * (columns.size() - 1) * (rows.size() - 1);
}

std::size_t coverNetwork(const HeightField& field, const DisplayVolume& volume, double error_mm, Heights& heights) {
  ReliefTriangles relief;
  relief.build(field, volume, {.error_mm = error_mm});
  const GridMapping& grid = field.grid();
  const auto corner = [&](std::size_t i) {
    const TexturedVertex& at = relief.vertices()[relief.indices()[i]];
    return Corner{static_cast<int>(std::lround(grid.u(static_cast<double>(at.x)))),
                  static_cast<int>(std::lround(grid.v(static_cast<double>(at.y)))), static_cast<double>(at.z)};
  };
  for (std::size_t i = 0; i < 3 * relief.surfaceTriangles(); i += 3) {
    heights.cover(corner(i), corner(i + 1), corner(i + 2));
  }
  return relief.indices().size() / 3;
}

}  // namespace

DrawnDepth drawnDepth(const HeightField& field, const DisplayVolume& volume, const DrawnLevel& level,
                      double pixels_per_mm) {
  Heights heights(field);
  const double error_mm = level.error_px * heightOfPixelMm({}, volume, pixels_per_mm);
  const std::size_t triangles =
      level.grid_step > 0 ? coverGrid(field, level.grid_step, heights) : coverNetwork(field, volume, error_mm, heights);
  return {heights.frame(volume.depth_mm), triangles};
}

}  // namespace relievo
