// SPDX-License-Identifier: Apache-2.0
// The cells of the lattice in which one object ends in front of another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/render/relief/height_lattice.h"

namespace relievo {

// A cell is cut if two neighbouring corners differ by more than `jump_mm`. If coding or a sensor has smeared a jump
// over several samples, each sample between takes the height of the nearer end of the run of jumps, since it belongs to
// neither object.
class CutCells {
 public:
  // Also replaces the heights of smeared samples.
  void find(HeightLattice& lattice, float jump_mm);

  // indices of top left vertices
  [[nodiscard]] const std::vector<std::uint32_t>& cells() const noexcept { return cells_; }
  [[nodiscard]] bool contains(std::size_t top_left) const noexcept { return cut_[top_left] != 0; }

 private:
  void scan(const HeightLattice& lattice);
  void sharpen(HeightLattice& lattice) const;
  void sharpenRun(float* first, int count, std::ptrdiff_t step) const noexcept;
  void lookAgain(const HeightLattice& lattice);

  float jump_mm_ = 0;
  std::vector<std::uint8_t> cut_;  // 1 at the top left vertex of a cut cell
  std::vector<std::uint32_t> cells_;
};

}  // namespace relievo
