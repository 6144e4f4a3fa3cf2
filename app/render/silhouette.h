// SPDX-License-Identifier: Apache-2.0
// What is drawn where one thing ends before another: the near side to its outline, the far side on behind it.
#pragma once

#include <cstdint>
#include <vector>

#include "app/render/height_lattice.h"
#include "app/render/textured_vertex.h"

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
  SilhouetteDrawer(const HeightLattice& lattice, const ViewSpan& view, std::vector<TexturedVertex>& vertices,
                   std::vector<std::uint32_t>& indices) noexcept
      : lattice_(lattice), view_(view), vertices_(vertices), indices_(indices) {}

  // `corner`: the lattice vertex at the cell's top left. `slots`: of a lattice vertex its place among the vertices,
  // counted from 1; 0 where it is not among them.
  void drawCell(std::uint32_t corner, const std::vector<std::uint32_t>& slots);

 private:
  struct Corner {
    TexturedVertex at;
    bool is_near;
  };
  // From the far to the near side, along one axis of the lattice.
  struct Way {
    int right, down;
  };
  void stepAside(Corner* corners, std::uint32_t corner, const std::vector<std::uint32_t>& slots);
  void drawNear(const Corner* corners);
  void drawFar(const Corner* corners, int i, int j);
  void extend(const TexturedVertex& first, const TexturedVertex& second, int i, int j, Way way);
  [[nodiscard]] float highest(int i, int j, Way way) const noexcept;
  void addStrip(const TexturedVertex& first, const TexturedVertex& second, Way way, float length);
  void addFan(const TexturedVertex* polygon, int count);

  const HeightLattice& lattice_;
  ViewSpan view_;
  std::vector<TexturedVertex>& vertices_;
  std::vector<std::uint32_t>& indices_;
};

}  // namespace relievo
