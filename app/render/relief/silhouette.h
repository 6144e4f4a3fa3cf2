// SPDX-License-Identifier: Apache-2.0
// What is drawn where one thing ends before another: the near side to its outline, the far side on behind it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "app/render/relief/height_lattice.h"
#include "app/render/relief/output_array.h"
#include "app/render/relief/textured_vertex.h"

namespace relievo {

// From where the relief is seen: eyes at y = 0, x within +-eye_mm, `distance_mm` before the screen plane.
struct ViewSpan {
  double eye_mm = 31.5;
  double distance_mm = 600;
  double screen_z_mm = 20;
  bool operator==(const ViewSpan&) const = default;
};

// A cell lies partly on a near and partly on a far thing: its corners are parted by the middle between its lowest and
// highest. The near corners get the part of the cell up to half way to the far ones, at the near height. The far side
// gets the whole cell at the far height, and behind the near side as much more as some eye sees past its outline, with
// the picture beside it mirrored: what is really there nobody has recorded. Right beside the outline the near thing's
// colour shines through: there the far side shows what is a little farther away.
class SilhouetteDrawer {
 public:
  SilhouetteDrawer(const HeightLattice& lattice, const ViewSpan& view, OutputArray<TexturedVertex>& vertices,
                   OutputArray<std::uint32_t>& indices) noexcept;

  // `corner`: the lattice vertex at the cell's top left. `slots`: of a lattice vertex its place among the vertices,
  // counted from 1; 0 where it is not among them.
  void drawCell(std::uint32_t corner, const std::vector<std::uint32_t>& slots);

 private:
  struct Cell {
    std::array<TexturedVertex, 4> corners{};  // counterclockwise to the viewer from the top left
    int i, j;                                 // of the top left vertex
  };
  // What is drawn of a cell, by which of its corners are near: bit k for corner k.
  struct CellCase {
    // The outline of the near part: corners (k, k), and middles between a near corner and a far one.
    std::array<std::array<std::uint8_t, 2>, 8> near{};
    std::array<std::uint8_t, 4> far{};       // its far corners
    std::array<std::uint8_t, 4> far_from{};  // where each corner of the far side has height and colour from
    int near_count = 0, far_count = 0;
    int aside_right = 0, aside_down = 0;  // where the far side lies: -1, 0 or 1
    bool near_right = false, near_left = false, near_below = false, near_above = false;  // sides that it lies behind
  };
  static constexpr CellCase caseOf(unsigned bits) noexcept;
  // A drawer for each case: nothing of it is looked up, or decided, cell by cell.
  using DrawCase = void (SilhouetteDrawer::*)(Cell& cell, const std::vector<std::uint32_t>& slots);
  static const std::array<DrawCase, 16> kCases;
  template <unsigned kBits>
  void drawCase(Cell& cell, const std::vector<std::uint32_t>& slots);
  // From the far to the near side, along one axis of the lattice.
  struct Way {
    int right, down;
  };
  template <unsigned kBits>
  void stepAside(Cell& cell, const std::vector<std::uint32_t>& slots);
  // Where the next vertex and index are written.
  struct Pen {
    TexturedVertex* vertex;
    std::uint32_t* index;
    std::uint32_t place;  // of the vertex
  };
  template <unsigned kBits>
  static void drawNear(Pen& pen, const Cell& cell);
  template <unsigned kBits>
  void drawFar(Pen& pen, const Cell& cell) const;
  void extend(Pen& pen, const TexturedVertex* corners, std::uint32_t place, std::size_t from, float covered_mm, int i,
              int j, Way way) const;
  [[nodiscard]] float highest(int i, int j, Way way) const noexcept;
  static void addFan(Pen& pen, int count);

  const HeightLattice& lattice_;
  ViewSpan view_;
  OutputArray<TexturedVertex>& vertices_;
  OutputArray<std::uint32_t>& indices_;
  float u_per_sample_, v_per_sample_, u_per_mm_, v_per_mm_;
};

}  // namespace relievo
