// SPDX-License-Identifier: Apache-2.0
// One pass over all cells; the rest visits only the cut ones.
#include "app/render/relief/cut_cells.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace relievo {
namespace {

// The largest step along a side of the cell whose top left vertex is `z`.
inline float stepOf(const float* z, std::ptrdiff_t width) noexcept {
  const float across = std::max(std::abs(z[1] - z[0]), std::abs(z[width + 1] - z[width]));
  const float down = std::max(std::abs(z[width] - z[0]), std::abs(z[width + 1] - z[1]));
  return std::max(across, down);
}

}  // namespace

void CutCells::find(HeightLattice& lattice, float jump_mm) {
  jump_mm_ = jump_mm;
  scan(lattice);
  if (cells_.empty()) return;
  sharpen(lattice);
  lookAgain(lattice);
}

void CutCells::scan(const HeightLattice& lattice) {
  const auto width = static_cast<std::size_t>(lattice.cols());
  cut_.resize(lattice.size() + sizeof(std::uint64_t));  // padded because it is read 8 bytes at a time
  cells_.clear();
  for (std::size_t j = 0; j + 1 < static_cast<std::size_t>(lattice.rows()); ++j) {
    const float* z = lattice.heights() + j * width;
    std::uint8_t* cut = cut_.data() + j * width;
    for (std::size_t i = 0; i + 1 < width; ++i) {
      cut[i] = stepOf(z + i, static_cast<std::ptrdiff_t>(width)) > jump_mm_ ? 1 : 0;
    }
    cut[width - 1] = 0;
    for (std::size_t i = 0; i < width; i += sizeof(std::uint64_t)) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, cut + i, sizeof eight);
      if (eight == 0) continue;
      for (std::size_t k = i; k < std::min(i + sizeof eight, width); ++k) {
        if (cut[k] != 0) cells_.push_back(static_cast<std::uint32_t>(j * width + k));
      }
    }
  }
}

// A smeared sample has a jump on both sides, so the cell with it as a corner is cut, and so is the cell before.
void CutCells::sharpen(HeightLattice& lattice) const {
  const int cols = lattice.cols(), rows = lattice.rows();
  for (const bool across : {true, false}) {
    const std::ptrdiff_t step = across ? 1 : cols;
    for (const std::uint32_t cell : cells_) {
      const int i = static_cast<int>(cell) % cols, j = static_cast<int>(cell) / cols;
      const int left = across ? cols - 1 - i : rows - 1 - j;
      if (left < 2) continue;
      for (const std::ptrdiff_t side : {std::ptrdiff_t{0}, across ? std::ptrdiff_t{cols} : std::ptrdiff_t{1}}) {
        float* z = lattice.heights() + cell + side;
        const float first = z[step] - z[0], second = z[2 * step] - z[step];
        const bool smeared = std::min(std::abs(first), std::abs(second)) > jump_mm_ && (first > 0) == (second > 0);
        if (smeared) sharpenRun(z, left, step);
      }
    }
  }
}

// `count`: steps to the picture's edge.
void CutCells::sharpenRun(float* first, int count, std::ptrdiff_t step) const noexcept {
  const auto jump = [&](int k) { return first[(k + 1) * step] - first[k * step]; };
  const bool up = jump(0) > 0;
  int end = 2;
  while (end < count && std::abs(jump(end)) > jump_mm_ && (jump(end) > 0) == up) ++end;
  const float begin_mm = first[0], end_mm = first[end * step];
  for (int k = 1; k < end; ++k) {
    float& z = first[k * step];
    z = std::abs(z - begin_mm) <= std::abs(end_mm - z) ? begin_mm : end_mm;
  }
}

// All cells around a changed sample were already cut, so no new ones can appear.
void CutCells::lookAgain(const HeightLattice& lattice) {
  std::erase_if(cells_, [&](std::uint32_t cell) {
    const bool cut = stepOf(lattice.heights() + cell, lattice.cols()) > jump_mm_;
    cut_[cell] = cut ? 1 : 0;
    return !cut;
  });
}

}  // namespace relievo
