// SPDX-License-Identifier: Apache-2.0
// A cut cell's two polygons, and the strips behind the near one.
#include "app/render/relief/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace relievo {
namespace {

// The corners of a cell, counterclockwise for the viewer from the top left.
constexpr std::array<int, 4> kRight{0, 0, 1, 1}, kDown{0, 1, 1, 0};

// The midpoint, at the height of the first vertex.
TexturedVertex middle(const TexturedVertex& a, const TexturedVertex& b) noexcept {
  return {0.5F * (a.x + b.x), 0.5F * (a.y + b.y), a.z, 0.5F * (a.u + b.u), 0.5F * (a.v + b.v)};
}

constexpr int signOf(int sum) noexcept {
  return (sum > 0) - (sum < 0);
}

}  // namespace

// The shapes to draw if the corners in `bits` are near: equal for all such cells.
constexpr SilhouetteDrawer::CellCase SilhouetteDrawer::caseOf(unsigned bits) noexcept {
  CellCase result;
  const auto is_near = [bits](std::size_t k) { return (bits >> k & 1U) != 0; };
  int right = 0, down = 0;  // direction of the far side
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    const auto addNear = [&](std::size_t a, std::size_t b) {
      result.near[static_cast<std::size_t>(result.near_count++)] = {static_cast<std::uint8_t>(a),
                                                                    static_cast<std::uint8_t>(b)};
    };
    if (is_near(k)) addNear(k, k);
    if (is_near(k) != is_near(next)) is_near(k) ? addNear(k, next) : addNear(next, k);
    const int sign = is_near(k) ? -1 : 1;
    right += sign * (2 * kRight[k] - 1);
    down += sign * (2 * kDown[k] - 1);
    if (!is_near(k)) result.far[static_cast<std::size_t>(result.far_count++)] = static_cast<std::uint8_t>(k);
    const std::size_t beside = 3 - k;  // 0-3 and 1-2 share a row
    const std::size_t below = k ^ 1U;  // 0-1 and 2-3 share a column
    const std::size_t from = !is_near(k) ? k : !is_near(beside) ? beside : !is_near(below) ? below : (k + 2) % 4;
    result.far_from[k] = static_cast<std::uint8_t>(from);
  }
  result.aside_right = signOf(right);
  result.aside_down = signOf(down);
  result.near_right = !is_near(0) && !is_near(1);
  result.near_left = !is_near(2) && !is_near(3);
  result.near_below = !is_near(0) && !is_near(3);
  result.near_above = !is_near(1) && !is_near(2);
  return result;
}

SilhouetteDrawer::SilhouetteDrawer(const HeightLattice& lattice, const ViewSpan& view,
                                   OutputArray<TexturedVertex>& vertices, OutputArray<std::uint32_t>& indices) noexcept
    : lattice_(lattice), view_(view), vertices_(vertices), indices_(indices) {
  const int right = lattice.cols() - 1, low = lattice.rows() - 1;
  u_per_sample_ = 1 / static_cast<float>(lattice.cols());
  v_per_sample_ = 1 / static_cast<float>(lattice.rows());
  u_per_mm_ = (lattice.u(right) - lattice.u(0)) / std::max(lattice.x(right) - lattice.x(0), 1e-6F);
  v_per_mm_ = (lattice.v(low) - lattice.v(0)) / std::max(lattice.y(0) - lattice.y(low), 1e-6F);
}

void SilhouetteDrawer::drawCell(std::uint32_t corner, const std::vector<std::uint32_t>& slots) {
  const int width = lattice_.cols();
  const int j = lattice_.rowOf(corner), i = static_cast<int>(corner) - j * width;
  Cell cell{.i = i, .j = j};
  const float* z = lattice_.heights() + corner;
  const float low = std::min({z[0], z[1], z[width], z[width + 1]});
  const float high = std::max({z[0], z[1], z[width], z[width + 1]});
  unsigned near = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const int c = i + kRight[k], r = j + kDown[k];
    const float height = z[kDown[k] * width + kRight[k]];
    cell.corners[k] = {lattice_.x(c), lattice_.y(r), height, lattice_.u(c), lattice_.v(r)};
    near |= (height > 0.5F * (low + high) ? 1U : 0U) << k;
  }
  (this->*kCases[near])(cell, slots);
}

// The far corners, and the surface vertices there, take their colour from slightly further away from the near corners.
template <unsigned kBits>
void SilhouetteDrawer::stepAside(Cell& cell, const std::vector<std::uint32_t>& slots) {
  static constexpr CellCase what = caseOf(kBits);
  constexpr float kSamples = 1.5F;
  const float by_u = kSamples * static_cast<float>(what.aside_right) * u_per_sample_;
  const float by_v = kSamples * static_cast<float>(what.aside_down) * v_per_sample_;
  const std::uint32_t* const place = slots.data() + cell.j * lattice_.cols() + cell.i;
  for (int n = 0; n < what.far_count; ++n) {
    const std::size_t k = what.far[static_cast<std::size_t>(n)];
    TexturedVertex& at = cell.corners[k];
    at.u += by_u;
    at.v += by_v;
    const std::uint32_t slot = place[kDown[k] * lattice_.cols() + kRight[k]];
    if (slot == 0) continue;
    vertices_[slot - 1].u = at.u;
    vertices_[slot - 1].v = at.v;
  }
}

// A triangle fan over the next `count` vertices, which the caller writes.
inline void SilhouetteDrawer::addFan(Pen& pen, int count) {
  for (std::uint32_t k = 2; k < static_cast<std::uint32_t>(count); ++k) {
    for (const std::uint32_t vertex : {0U, k - 1, k}) *pen.index++ = pen.place + vertex;
  }
  pen.place += static_cast<std::uint32_t>(count);
}

template <unsigned kBits>
void SilhouetteDrawer::drawNear(Pen& pen, const Cell& cell) {
  static constexpr CellCase what = caseOf(kBits);
  addFan(pen, what.near_count);
  for (int n = 0; n < what.near_count; ++n) {
    const auto [k, other] = what.near[static_cast<std::size_t>(n)];
    *pen.vertex++ = middle(cell.corners[k], cell.corners[other]);
  }
}

// Each near corner takes height and colour from the far corner beside, above or below it, or diagonally opposite.
template <unsigned kBits>
void SilhouetteDrawer::drawFar(Pen& pen, const Cell& cell) const {
  static constexpr CellCase what = caseOf(kBits);
  const std::uint32_t place = pen.place;
  const TexturedVertex* const corners = pen.vertex;
  addFan(pen, 4);
  for (std::size_t k = 0; k < 4; ++k) {
    const TexturedVertex &at = cell.corners[k], &from = cell.corners[what.far_from[k]];
    *pen.vertex++ = {at.x, at.y, from.z, from.u, from.v};
  }
  const float half_across = 0.5F * (cell.corners[2].x - cell.corners[0].x);
  const float half_down = 0.5F * (cell.corners[0].y - cell.corners[2].y);
  const int i = cell.i, j = cell.j;
  if (what.near_right) extend(pen, corners, place, 2, half_across, i + 1, j, {1, 0});
  if (what.near_left) extend(pen, corners, place, 0, half_across, i, j, {-1, 0});
  if (what.near_below) extend(pen, corners, place, 1, half_down, i, j + 1, {0, 1});
  if (what.near_above) extend(pen, corners, place, 3, half_down, i, j, {0, -1});
}

// Extends the far side behind the near object. The cell side from corner `from` to the next (vertices `place` onwards)
// lies behind the near object, which begins at or beside vertex (i, j). The extension reaches as far as an eye sees
// past the outline, minus the `covered_mm` that the cell itself covers. A round object hides more than its rim.
inline void SilhouetteDrawer::extend(Pen& pen, const TexturedVertex* corners, std::uint32_t place, std::size_t from,
                                     float covered_mm, int i, int j, Way way) const {
  const std::size_t to = (from + 1) % 4;
  const TexturedVertex &first = corners[from], &second = corners[to];
  const float far_z = 0.5F * (first.z + second.z);
  const float near_z = highest(i, j, way);
  const float distance = static_cast<float>(view_.distance_mm + view_.screen_z_mm) - near_z;
  const float outline = way.right != 0 ? static_cast<float>(way.right) * first.x + static_cast<float>(view_.eye_mm)
                                       : static_cast<float>(-way.down) * first.y;
  const float length = (near_z - far_z) * outline / std::max(distance, 1.0F);
  if (length <= covered_mm) return;
  const float right = static_cast<float>(way.right) * length, down = static_cast<float>(way.down) * length;
  const auto beyond = [&](const TexturedVertex& at) {  // mirrored back into the far side
    return TexturedVertex{at.x + right, at.y - down, at.z, at.u - right * u_per_mm_, at.v - down * v_per_mm_};
  };
  const auto a = place + static_cast<std::uint32_t>(from), b = place + static_cast<std::uint32_t>(to);
  for (const std::uint32_t vertex : {pen.place, pen.place + 1, b, pen.place, b, a}) *pen.index++ = vertex;
  *pen.vertex++ = beyond(first);
  *pen.vertex++ = beyond(second);
  pen.place += 2;
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

template <unsigned kBits>
void SilhouetteDrawer::drawCase(Cell& cell, const std::vector<std::uint32_t>& slots) {
  constexpr std::size_t kMostVertices = 8 + 4 + 4 * 2, kMostIndices = 3 * (6 + 2 + 4 * 2);
  Pen pen{vertices_.room(kMostVertices), indices_.room(kMostIndices), static_cast<std::uint32_t>(vertices_.size())};
  drawNear<kBits>(pen, cell);
  stepAside<kBits>(cell, slots);
  drawFar<kBits>(pen, cell);
  vertices_.endAt(pen.vertex);
  indices_.endAt(pen.index);
}

constexpr std::array<SilhouetteDrawer::DrawCase, 16> SilhouetteDrawer::kCases =
    []<unsigned... kBits>(std::integer_sequence<unsigned, kBits...>) {
      return std::array<DrawCase, 16>{&SilhouetteDrawer::drawCase<kBits>...};
    }(std::make_integer_sequence<unsigned, 16>());

}  // namespace relievo
