// SPDX-License-Identifier: Apache-2.0
// Back-projects each depth pixel, transforms it into the colour camera's frame and projects it onto that camera's
// picture.
#include "app/media/registration.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace relievo {
namespace {

constexpr double kNearestMm = 1;  // distance in front of the colour camera
constexpr std::uint32_t kLargestCode = 0xffff;

// The same camera at another picture size.
PinholeCamera scaled(const PinholeCamera& camera, int cols, int rows) noexcept {
  const double x = cols / camera.cols, y = rows / camera.rows;
  return {.cols = static_cast<double>(cols),
          .rows = static_cast<double>(rows),
          .focal_x = camera.focal_x * x,
          .focal_y = camera.focal_y * y,
          .center_x = (camera.center_x + 0.5) * x - 0.5,
          .center_y = (camera.center_y + 0.5) * y - 0.5};
}

struct Point {
  double x, y, z;
};

// The picture being made.
struct Target {
  int cols, rows;
  std::vector<std::uint16_t> codes;

  // Fills the pixels whose centres lie in the plate, so that adjacent plates neither leave gaps nor overlap.
  void cover(double u, double v, double half_width, double half_height, std::uint16_t code) noexcept {
    const auto first = [](double edge) { return static_cast<int>(std::ceil(std::clamp(edge, -1.0, 1e6))); };
    const int c0 = std::max(first(u - half_width), 0), c1 = std::min(first(u + half_width), cols);
    const int r0 = std::max(first(v - half_height), 0), r1 = std::min(first(v + half_height), rows);
    for (int r = r0; r < r1; ++r) {
      std::uint16_t* const row = codes.data() + static_cast<std::ptrdiff_t>(r) * cols;
      for (int c = c0; c < c1; ++c) {
        if (row[c] == 0 || code < row[c]) row[c] = code;
      }
    }
  }
};

}  // namespace

Result<Frame> registered(const Frame& depth, const Registration& registration) {
  if (depth.empty() || depth.model == ColorModel::Rgb || depth.width < 1 || depth.height < 1) {
    return fail(ErrorCode::Unsupported, "registration needs gray depth whose codes are distances");
  }
  const PinholeCamera from = scaled(registration.depth, depth.width, depth.height);
  Target target{depth.width, 0, {}};
  target.rows =
      std::max(1, static_cast<int>(std::lround(target.cols * registration.color.rows / registration.color.cols)));
  target.codes.resize(static_cast<std::size_t>(target.cols) * static_cast<std::size_t>(target.rows));
  const PinholeCamera to = scaled(registration.color, target.cols, target.rows);

  const double unit_mm = registration.unit_mm * (depth.value_per_code == 0 ? 1 : std::abs(depth.value_per_code));
  const auto& m = registration.rotation;
  const auto& t = registration.translation_mm;
  const Component& where = depth.components[0];
  const Plane& plane = depth.planes[where.plane];
  for (int r = 0; r < depth.height; ++r) {
    const std::uint8_t* sample = plane.data + r * plane.stride_bytes + where.offset_bytes;
    const double y = (r - from.center_y) / from.focal_y;
    for (int c = 0; c < depth.width; ++c, sample += where.step_bytes) {
      const std::uint32_t code = codeAt(where, sample);
      if (code == 0) continue;
      const double z = code * unit_mm;
      const double x = (c - from.center_x) / from.focal_x;
      const Point p{z * (m[0] * x + m[1] * y + m[2]) + t[0], z * (m[3] * x + m[4] * y + m[5]) + t[1],
                    z * (m[6] * x + m[7] * y + m[8]) + t[2]};
      if (p.z < kNearestMm) continue;
      const double there = std::round(p.z / unit_mm);
      if (there < 1 || there > kLargestCode) continue;
      const double shrinks = z / p.z / 2;
      target.cover(to.focal_x * p.x / p.z + to.center_x, to.focal_y * p.y / p.z + to.center_y,
                   shrinks * to.focal_x / from.focal_x, shrinks * to.focal_y / from.focal_y,
                   static_cast<std::uint16_t>(there));
    }
  }

  Frame frame =
      grayFrame(std::make_shared<const std::vector<std::uint16_t>>(std::move(target.codes)), target.cols, target.rows);
  frame.value_per_code = depth.value_per_code;
  frame.pts = depth.pts;
  frame.duration = depth.duration;
  return frame;
}

}  // namespace relievo
