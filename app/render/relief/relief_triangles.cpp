// SPDX-License-Identifier: Apache-2.0
// The network's triangles, the frame around them and the silhouettes.
#include "app/render/relief/relief_triangles.h"

#include <algorithm>

namespace relievo {

namespace {

bool sameBox(const DisplayVolume& a, const DisplayVolume& b) noexcept {
  return a.width_mm == b.width_mm && a.height_mm == b.height_mm && a.depth_mm == b.depth_mm;
}

}  // namespace

int ReliefDetail::cellsFor(double pixels, double factor) noexcept {
  constexpr double kCellsPerPixel = 4.0 / 3, kWidest = 2;
  constexpr int kLeast = 64, kMost = 1024;  // more take too long
  return std::clamp(static_cast<int>(kCellsPerPixel * pixels / std::min(factor, kWidest)), kLeast, kMost);
}

bool ReliefTriangles::build(const HeightField& field, const DisplayVolume& volume, const ReliefDetail& detail) {
  const bool changed = lattice_.read(field, detail.most_across);
  if (!changed && made_ == detail && sameBox(made_volume_, volume)) return false;
  make(volume, detail);
  made_ = detail;
  made_volume_ = volume;
  return true;
}

void ReliefTriangles::make(const DisplayVolume& volume, const ReliefDetail& detail) {
  cuts_.find(lattice_, lattice_.jumpMm());
  network_.measure(lattice_, cuts_);
  network_.triangulate(static_cast<float>(detail.error_mm));
  vertices_.clear();
  TexturedVertex* at = vertices_.room(network_.vertices().size());
  for (const std::uint32_t vertex : network_.vertices()) {
    const int j = lattice_.rowOf(vertex), i = static_cast<int>(vertex) - j * lattice_.cols();
    *at++ = {lattice_.x(i), lattice_.y(j), lattice_.heights()[vertex], lattice_.u(i), lattice_.v(j)};
  }
  vertices_.endAt(at);
  indices_.clear();
  std::uint32_t* index = indices_.room(3 * network_.triangles().size());
  for (const auto& [a, b, c] : network_.triangles()) {
    for (const std::uint32_t place : {a, b, c}) *index++ = place;
  }
  indices_.endAt(index);
  addFrame(volume, static_cast<float>(detail.view.screen_z_mm));
  SilhouetteDrawer silhouettes(lattice_, detail.view, vertices_, indices_);
  for (const std::uint32_t corner : cuts_.cells()) silhouettes.drawCell(corner, network_.slots());
  addFloor(volume, static_cast<float>(detail.view.screen_z_mm));
}

// A strip along each side, between its used vertices and the picture's rectangle.
void ReliefTriangles::addFrame(const DisplayVolume& volume, float screen_z_mm) {
  const int right = lattice_.cols() - 1, low = lattice_.rows() - 1;
  const auto half_width = static_cast<float>(0.5 * volume.width_mm),
             half_height = static_cast<float>(0.5 * volume.height_mm);
  const auto outer = [&](const TexturedVertex& at, int i, int j) {
    TexturedVertex out{at.x, at.y, screen_z_mm, at.u, at.v};
    if (i == 0 || i == right) out.x = i == 0 ? -half_width : half_width, out.u = i == 0 ? 0.0F : 1.0F;
    if (j == 0 || j == low) out.y = j == 0 ? half_height : -half_height, out.v = j == 0 ? 0.0F : 1.0F;
    return out;
  };
  // Clockwise around the picture: the outside is on the left.
  const auto walk = [&](int i, int j, int step_i, int step_j, int count) {
    std::uint32_t before = 0, outside_before = 0;
    bool begun = false;
    for (int k = 0; k <= count; ++k, i += step_i, j += step_j) {
      const auto vertex = static_cast<std::uint32_t>(j * lattice_.cols() + i);
      const std::uint32_t slot = network_.slots()[vertex];
      if (slot == 0) continue;  // corners are always used
      const std::uint32_t inner = slot - 1;
      const auto outside = static_cast<std::uint32_t>(vertices_.size());
      vertices_.add({{outer(vertices_[inner], i, j)}});
      if (begun) indices_.add({{before, inner, outside, before, outside, outside_before}});
      before = inner;
      outside_before = outside;
      begun = true;
    }
  };
  walk(0, 0, 1, 0, right);
  walk(right, 0, 0, 1, low);
  walk(right, low, -1, 0, right);
  walk(0, low, 0, -1, low);
}

// A box behind the picture's rectangle, open towards the viewer.
void ReliefTriangles::addFloor(const DisplayVolume& volume, float screen_z_mm) {
  constexpr float kBelowMm = 0.5F;
  const auto x = static_cast<float>(0.5 * volume.width_mm), y = static_cast<float>(0.5 * volume.height_mm);
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  for (const float z : {-kBelowMm, screen_z_mm}) {
    vertices_.add({{{-x, y, z, 0, 0}, {-x, -y, z, 0, 1}, {x, -y, z, 1, 1}, {x, y, z, 1, 0}}});
  }
  const auto addQuad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    indices_.add({{first + a, first + b, first + c, first + a, first + c, first + d}});
  };
  addQuad(0, 1, 2, 3);
  for (std::uint32_t k = 0; k < 4; ++k) addQuad(k, k + 4, (k + 1) % 4 + 4, (k + 1) % 4);
}

}  // namespace relievo
