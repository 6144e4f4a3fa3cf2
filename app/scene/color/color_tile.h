// SPDX-License-Identifier: Apache-2.0
// A part of a block of colours: its samples in cells of 2 x 2, summed by the piece of the curve that they lie on.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "app/scene/color/color_samples.h"
#include "app/scene/color/color_table.h"
#include "platform/realtime.h"

namespace relievo {

// Up to eight cells across, and the rows of cells of up to 16 rows of samples. At its ends a cell may have only one
// column or row that counts. The mean colour of cells on one straight piece of the curve is the colour of their mean
// position.
struct ColorTile {
  static constexpr int kMostColumns = 16, kMostRows = 16;  // so that sums of codes of 8 bits need 16 bits
  using Sums = std::array<std::uint16_t, 4>;    // of the three codes, as codes of 8 bits, and the number of samples
  using Places = std::array<std::uint32_t, 8>;  // of cells in a ColorTable

  int begin = 0;            // column of the first cell; even
  int left = 0, right = 0;  // the columns that count: `left` to `right`, without that
  int top = 0, step = 1;    // the first row that counts, and from there to the next
  int rows = 0;
  // Filled in by ColorSamples::readTile.
  std::array<std::uint64_t, ColorTable::kMostPieces + 1> sums;  // by piece: Sums, as one number
  alignas(16) std::array<Places, kMostRows> places;             // by the first row of the cells that counts
  std::uint64_t used;                                           // a bit for each piece

  [[nodiscard]] int cells() const RELIEVO_RT { return (right - begin + 1) / 2; }
  [[nodiscard]] int leftOf(int cell) const RELIEVO_RT { return std::max(begin + 2 * cell, left); }
  [[nodiscard]] int rightOf(int cell) const RELIEVO_RT { return std::min(begin + 2 * cell + 2, right); }
  [[nodiscard]] int rowAt(int row) const RELIEVO_RT { return top + row * step; }
  // How many rows, from this one on, are in its cells: two from an even one on.
  [[nodiscard]] int rowsFrom(int row) const RELIEVO_RT {
    return step == 1 && (top + row) % 2 == 0 && row + 1 < rows ? 2 : 1;
  }
};

}  // namespace relievo
