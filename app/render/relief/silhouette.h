// SPDX-License-Identifier: Apache-2.0
// Draws the silhouettes: the near side up to its outline, and the far side extended behind it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "app/render/relief/height_lattice.h"
#include "app/render/relief/output_array.h"
#include "app/render/relief/textured_vertex.h"

namespace relievo {

// The viewing positions: eyes at y = 0, x within +-eye_mm, `distance_mm` in front of the screen plane.
struct ViewSpan {
  double eye_mm = 31.5;
  double distance_mm = 600;
  double screen_z_mm = 20;
  bool operator==(const ViewSpan&) const = default;
};

// A cut cell lies partly on a near and partly on a far object: its corners are divided at the mean of its lowest and
// highest. The near part, up to half way to the far corners, is drawn at the near height. The far side gets the whole
// cell at the far height, and behind the near side as much more as an eye sees past its outline, textured with the
// mirrored picture beside it, since the hidden part was never recorded. Right beside the outline the near object's
// colour bleeds into the picture, so the far side takes its colour from slightly further away.
class SilhouetteDrawer {
 public:
  SilhouetteDrawer(const HeightLattice& lattice, const ViewSpan& view, OutputArray<TexturedVertex>& vertices,
                   OutputArray<std::uint32_t>& indices) noexcept;

  // `corner`: the lattice vertex at the cell's top left. `slots`: for each lattice vertex its index in the vertex list
  // plus 1; 0 if it is not in the list.
  void drawCell(std::uint32_t corner, const std::vector<std::uint32_t>& slots);

 private:
  struct Cell {
    std::array<TexturedVertex, 4> corners{};  // counterclockwise for the viewer from the top left
    int i, j;                                 // of the top left vertex
  };
  // The shapes of a cell for one set of near corners: bit k for corner k.
  struct CellCase {
    // The outline of the near part: corners (k, k), and midpoints between a near corner and a far one.
    std::array<std::array<std::uint8_t, 2>, 8> near{};
    std::array<std::uint8_t, 4> far{};       // its far corners
    std::array<std::uint8_t, 4> far_from{};  // the corner that each corner of the far side takes height and colour from
    int near_count = 0, far_count = 0;
    int aside_right = 0, aside_down = 0;  // direction of the far side: -1, 0 or 1
    // cell sides that lie behind the near object
    bool near_right = false, near_left = false, near_below = false, near_above = false;
  };
  static constexpr CellCase caseOf(unsigned bits) noexcept;
  // One drawing function per case, so that nothing is decided cell by cell.
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
    std::uint32_t place;  // index of that vertex
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
