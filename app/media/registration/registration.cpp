// SPDX-License-Identifier: Apache-2.0
// Back-projects each depth pixel, transforms it into the colour camera's frame and projects it onto that camera's
// picture.
#include "app/media/registration/registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "hal/media/video_decoder.h"

namespace relievo {
namespace {

constexpr double kNearestMm = 1;  // distance in front of the colour camera
constexpr std::uint32_t kLargestCode = 0xffff;
constexpr double kOverlap = 0.02;  // pixels; plates that a lens bends would leave cracks

// The same camera at another picture size.
RigCamera scaled(const RigCamera& camera, int cols, int rows) noexcept {
  const double x = cols / camera.cols, y = rows / camera.rows;
  return {.cols = static_cast<double>(cols),
          .rows = static_cast<double>(rows),
          .focal_x = camera.focal_x * x,
          .focal_y = camera.focal_y * y,
          .center_x = (camera.center_x + 0.5) * x - 0.5,
          .center_y = (camera.center_y + 0.5) * y - 0.5};
}

// The smaller of two steps, 0 if they differ in sign: at an edge the level side wins.
float agreed(float a, float b) noexcept {
  if (a * b <= 0) return 0;
  return std::abs(a) < std::abs(b) ? a : b;
}

// The picture being made.
struct Target {
  int cols, rows;
  std::vector<std::uint16_t> codes;

  // Fills the pixels whose centres lie in the plate, so that adjacent plates neither leave gaps nor overlap.
  template <class Plate, class Slope>
  void cover(const Plate& plate, const Slope& slope) noexcept {
    const auto first = [](float edge) { return static_cast<int>(std::ceil(std::clamp(edge, -1.0F, 1e6F))); };
    const int c0 = std::max(first(plate.u - plate.half_width), 0);
    const int c1 = std::min(first(plate.u + plate.half_width), cols);
    const int r0 = std::max(first(plate.v - plate.half_height), 0);
    const int r1 = std::min(first(plate.v + plate.half_height), rows);
    for (int r = r0; r < r1; ++r) {
      std::uint16_t* const row = codes.data() + static_cast<std::ptrdiff_t>(r) * cols;
      const float left = plate.code + slope.y * (static_cast<float>(r) - plate.v);
      for (int c = c0; c < c1; ++c) {
        const float there = std::round(left + slope.x * (static_cast<float>(c) - plate.u));
        if (!(there >= 1) || there >= kLargestCode) continue;
        const auto code = static_cast<std::uint16_t>(there);
        if (row[c] == 0 || code < row[c]) row[c] = code;
      }
    }
  }
};

}  // namespace

Registrar::Registrar(const Registration& registration)
    : registration_(registration),
      depth_lens_(registration.depth.distortion),
      color_lens_(registration.color.distortion) {}

// Half a pixel's size, measured along its row and its column.
void Registrar::aim(int cols, int rows) {
  if (cols_ == cols && rows_ == rows) return;
  cols_ = cols;
  rows_ = rows;
  const RigCamera camera = scaled(registration_.depth, cols, rows);
  const auto rayAt = [&](double c, double r) {
    return depth_lens_.rayAt({(c - camera.center_x) / camera.focal_x, (r - camera.center_y) / camera.focal_y});
  };
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  rays_.clear();
  rays_.reserve(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const auto ray = rayAt(c, r);
      Ray& made = rays_.emplace_back(kNone, kNone, 0.5 / camera.focal_x, 0.5 / camera.focal_y);
      if (!ray) continue;
      made.x = ray->x;
      made.y = ray->y;
      if (!depth_lens_.bends()) continue;
      const auto right = rayAt(c + 0.5, r), below = rayAt(c, r + 0.5);
      if (right) made.half_width = std::abs(right->x - ray->x);
      if (below) made.half_height = std::abs(below->y - ray->y);
    }
  }
}

// Moves each sample into the colour's picture.
void Registrar::see(const Frame& depth, const RigCamera& to) {
  const double overlap = depth_lens_.bends() || color_lens_.bends() ? kOverlap : 0;
  const auto& m = registration_.rotation;
  const auto& t = registration_.translation_mm;
  const double unit_mm = registration_.unit_mm * (depth.value_per_code == 0 ? 1 : std::abs(depth.value_per_code));
  const Component& where = depth.components[0];
  const Plane& plane = depth.planes[where.plane];
  seen_.assign(rays_.size(), {});
  for (int r = 0; r < depth.height; ++r) {
    const std::size_t begin = static_cast<std::size_t>(r) * static_cast<std::size_t>(depth.width);
    const std::uint8_t* sample = plane.data + r * plane.stride_bytes + where.offset_bytes;
    for (std::size_t i = begin; i < begin + static_cast<std::size_t>(depth.width); ++i, sample += where.step_bytes) {
      const std::uint32_t code = codeAt(where, sample);
      if (code == 0 || code == kLargestCode) continue;
      const Ray& ray = rays_[i];
      const double z = code * unit_mm;
      const double there = z * (m[6] * ray.x + m[7] * ray.y + m[8]) + t[2];
      if (!(there >= kNearestMm)) continue;
      const auto seen = color_lens_.see({(z * (m[0] * ray.x + m[1] * ray.y + m[2]) + t[0]) / there,
                                         (z * (m[3] * ray.x + m[4] * ray.y + m[5]) + t[1]) / there});
      if (!seen) continue;
      const double shrinks = z / there;
      seen_[i] = {
          .u = static_cast<float>(to.focal_x * seen->point.x + to.center_x),
          .v = static_cast<float>(to.focal_y * seen->point.y + to.center_y),
          .half_width = static_cast<float>(shrinks * to.focal_x * ray.half_width * seen->scale_x + overlap),
          .half_height = static_cast<float>(shrinks * to.focal_y * ray.half_height * seen->scale_y + overlap),
          .code = static_cast<float>(there / unit_mm),
      };
    }
  }
}

// From the sample's four neighbours; 0 beside a hole or the rim.
Registrar::Slope Registrar::slopeAt(std::size_t i) const noexcept {
  const auto cols = static_cast<std::size_t>(cols_);
  const std::size_t c = i % cols, r = i / cols;
  if (c == 0 || r == 0 || c + 1 == cols || r + 1 == static_cast<std::size_t>(rows_)) return {};
  const Seen &left = seen_[i - 1], &right = seen_[i + 1], &above = seen_[i - cols], &below = seen_[i + cols];
  if (left.code == 0 || right.code == 0 || above.code == 0 || below.code == 0) return {};
  const float code = seen_[i].code;
  const float across = agreed(right.code - code, code - left.code);
  const float down = agreed(below.code - code, code - above.code);
  const float across_u = (right.u - left.u) / 2, across_v = (right.v - left.v) / 2;
  const float down_u = (below.u - above.u) / 2, down_v = (below.v - above.v) / 2;
  const float determinant = across_u * down_v - across_v * down_u;
  constexpr float kFlat = 1e-3F;  // square pixels
  if (std::abs(determinant) < kFlat) return {};
  return {(across * down_v - down * across_v) / determinant, (down * across_u - across * down_u) / determinant};
}

Result<Frame> Registrar::registered(const Frame& depth) {
  if (depth.empty() || depth.model == ColorModel::Rgb || depth.width < 1 || depth.height < 1) {
    return fail(ErrorCode::Unsupported, "registration needs gray depth whose codes are distances");
  }
  const RigCamera& color = registration_.color;
  const double rows = std::max(1.0, std::round(depth.width * color.rows / color.cols));
  if (rows * depth.width > static_cast<double>(VideoDecoder::kMostSamples)) {
    return fail(ErrorCode::Unsupported, "the registration's colour picture is far too narrow; check its size");
  }
  aim(depth.width, depth.height);
  Target target{depth.width, static_cast<int>(rows), {}};
  target.codes.resize(static_cast<std::size_t>(target.cols) * static_cast<std::size_t>(target.rows));
  see(depth, scaled(color, target.cols, target.rows));
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (seen_[i].code > 0) target.cover(seen_[i], slopeAt(i));
  }
  Frame frame =
      grayFrame(std::make_shared<const std::vector<std::uint16_t>>(std::move(target.codes)), target.cols, target.rows);
  frame.value_per_code = depth.value_per_code;
  frame.value_at_zero = depth.value_at_zero;
  frame.pts = depth.pts;
  frame.duration = depth.duration;
  return frame;
}

}  // namespace relievo
