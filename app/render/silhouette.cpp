// SPDX-License-Identifier: Apache-2.0
// The cell's two polygons, and the strips behind the near one.
#include "app/render/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relievo {
namespace {

// The corners of a cell, counterclockwise to the viewer from the top left.
constexpr std::array<int, 4> kRight{0, 0, 1, 1}, kDown{0, 1, 1, 0};

TexturedVertex middle(const TexturedVertex& a, const TexturedVertex& b, float z) noexcept {
  return {0.5F * (a.x + b.x), 0.5F * (a.y + b.y), z, 0.5F * (a.u + b.u), 0.5F * (a.v + b.v)};
}

}  // namespace

void SilhouetteDrawer::drawCell(std::uint32_t corner, const std::vector<std::uint32_t>& slots) {
  const int width = lattice_.cols();
  const int i = static_cast<int>(corner) % width, j = static_cast<int>(corner) / width;
  std::array<Corner, 4> corners;
  float low = HUGE_VALF, high = -HUGE_VALF;
  for (std::size_t k = 0; k < 4; ++k) {
    const int c = i + kRight[k], r = j + kDown[k];
    const float z = lattice_.heights()[r * width + c];
    corners[k].at = {lattice_.x(c), lattice_.y(r), z, lattice_.u(c), lattice_.v(r)};
    low = std::min(low, z);
    high = std::max(high, z);
  }
  for (Corner& one : corners) one.is_near = one.at.z > 0.5F * (low + high);
  drawNear(corners.data());
  stepAside(corners.data(), corner, slots);
  drawFar(corners.data(), i, j);
}

// The far corners, and the vertices of the surface there, show the picture a little away from the near ones.
void SilhouetteDrawer::stepAside(Corner* corners, std::uint32_t corner, const std::vector<std::uint32_t>& slots) {
  constexpr float kSamples = 1.5F;
  int right = 0, down = 0;  // where the far side lies
  for (std::size_t k = 0; k < 4; ++k) {
    const int sign = corners[k].is_near ? -1 : 1;
    right += sign * (2 * kRight[k] - 1);
    down += sign * (2 * kDown[k] - 1);
  }
  const auto toward = [](int sum) { return sum > 0 ? kSamples : sum < 0 ? -kSamples : 0.0F; };
  const float by_u = toward(right) / static_cast<float>(lattice_.cols());
  const float by_v = toward(down) / static_cast<float>(lattice_.rows());
  for (std::size_t k = 0; k < 4; ++k) {
    if (corners[k].is_near) continue;
    corners[k].at.u += by_u;
    corners[k].at.v += by_v;
    const std::uint32_t slot = slots[corner + static_cast<std::uint32_t>(kDown[k] * lattice_.cols() + kRight[k])];
    if (slot == 0) continue;
    vertices_[slot - 1].u = corners[k].at.u;
    vertices_[slot - 1].v = corners[k].at.v;
  }
}

void SilhouetteDrawer::drawNear(const Corner* corners) {
  std::array<TexturedVertex, 8> polygon;
  int count = 0;
  for (int k = 0; k < 4; ++k) {
    const Corner& here = corners[k];
    const Corner& next = corners[(k + 1) % 4];
    if (here.is_near) polygon[static_cast<std::size_t>(count++)] = here.at;
    if (here.is_near == next.is_near) continue;
    const float z = here.is_near ? here.at.z : next.at.z;
    polygon[static_cast<std::size_t>(count++)] = middle(here.at, next.at, z);
  }
  addFan(polygon.data(), count);
}

// A near corner takes the height and the colour of the far one beside it, above or below it, or across.
void SilhouetteDrawer::drawFar(const Corner* corners, int i, int j) {
  std::array<TexturedVertex, 4> polygon;
  const auto is_near = [corners](std::size_t k) { return corners[k].is_near; };
  for (std::size_t k = 0; k < 4; ++k) {
    polygon[k] = corners[k].at;
    if (!is_near(k)) continue;
    const std::size_t beside = 3 - k;  // 0-3 and 1-2 share a row
    const std::size_t below = k ^ 1U;  // 0-1 and 2-3 a column
    const std::size_t from = !is_near(beside) ? beside : !is_near(below) ? below : (k + 2) % 4;
    polygon[k].z = corners[from].at.z;
    polygon[k].u = corners[from].at.u;
    polygon[k].v = corners[from].at.v;
  }
  addFan(polygon.data(), 4);
  if (!is_near(0) && !is_near(1)) extend(polygon[2], polygon[3], i + 1, j, {1, 0});
  if (!is_near(2) && !is_near(3)) extend(polygon[0], polygon[1], i, j, {-1, 0});
  if (!is_near(0) && !is_near(3)) extend(polygon[1], polygon[2], i, j + 1, {0, 1});
  if (!is_near(1) && !is_near(2)) extend(polygon[3], polygon[0], i, j, {0, -1});
}

// `first` to `second` is the side of the cell that lies behind the near thing, which begins at vertex (i, j) or beside
// it: how far some eye sees behind its outline. A round thing hides more than its rim does.
void SilhouetteDrawer::extend(const TexturedVertex& first, const TexturedVertex& second, int i, int j, Way way) {
  const float far_z = 0.5F * (first.z + second.z);
  const float near_z = highest(i, j, way);
  const float distance = static_cast<float>(view_.distance_mm + view_.screen_z_mm) - near_z;
  const float outline = way.right != 0 ? static_cast<float>(way.right) * first.x + static_cast<float>(view_.eye_mm)
                                       : static_cast<float>(-way.down) * first.y;
  const float length = (near_z - far_z) * outline / std::max(distance, 1.0F);
  if (length > 0) addStrip(first, second, way, length);
}

float SilhouetteDrawer::highest(int i, int j, Way way) const noexcept {
  constexpr int kSamples = 8;
  const int to_side = way.right != 0 ? 1 : 0, below = 1 - to_side;  // the side's other vertex: below, or to the right
  float high = 0;
  for (int k = 0; k < kSamples; ++k, i += way.right, j += way.down) {
    if (i < 0 || j < 0 || i + below >= lattice_.cols() || j + to_side >= lattice_.rows()) break;
    const float* z = lattice_.heights() + static_cast<std::ptrdiff_t>(j) * lattice_.cols() + i;
    high = std::max({high, z[0], z[below + to_side * lattice_.cols()]});
  }
  return high;
}

void SilhouetteDrawer::addStrip(const TexturedVertex& first, const TexturedVertex& second, Way way, float length) {
  const float mm_across = std::max(lattice_.x(lattice_.cols() - 1) - lattice_.x(0), 1e-6F);
  const float mm_down = std::max(lattice_.y(0) - lattice_.y(lattice_.rows() - 1), 1e-6F);
  const float u_per_mm = (lattice_.u(lattice_.cols() - 1) - lattice_.u(0)) / mm_across;
  const float v_per_mm = (lattice_.v(lattice_.rows() - 1) - lattice_.v(0)) / mm_down;
  const auto right = static_cast<float>(way.right), down = static_cast<float>(way.down);
  const auto beyond = [&](TexturedVertex at) {
    at.x += right * length;
    at.y -= down * length;
    at.u -= right * length * u_per_mm;  // back into the far side
    at.v -= down * length * v_per_mm;
    return at;
  };
  const std::array<TexturedVertex, 4> strip{beyond(first), beyond(second), second, first};
  addFan(strip.data(), 4);
}

void SilhouetteDrawer::addFan(const TexturedVertex* polygon, int count) {
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  for (int k = 0; k < count; ++k) vertices_.push_back(polygon[k]);
  for (std::uint32_t k = 2; k < static_cast<std::uint32_t>(count); ++k) {
    for (const std::uint32_t vertex : {first, first + k - 1, first + k}) indices_.push_back(vertex);
  }
}

}  // namespace relievo
