// SPDX-License-Identifier: Apache-2.0
// Makes sizes even, as 4:2:0 needs them.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include "hal/media/frame.h"

namespace relievo {

// What to crop at the right and bottom: the odd column or row of a 4:2:0 picture, and of the other picture the same
// share of the view, to within half a depth sample.
struct EvenCut {
  int color_cols = 0, color_rows = 0, depth_cols = 0, depth_rows = 0;

  EvenCut() = default;
  EvenCut(const Frame& color, const Frame& depth, bool even_depth) {
    cut(color.width, depth.width, even_depth, color_cols, depth_cols);
    cut(color.height, depth.height, even_depth, color_rows, depth_rows);
  }

  // The least crop after which both sizes are even where required.
  static void cut(int color, int depth, bool even_depth, int& off_color, int& off_depth) {
    const auto isOdd = [&] { return even_depth && (depth - off_depth) % 2 != 0; };
    for (off_color = color % 2; off_color + 2 < color; off_color += 2) {
      off_depth = static_cast<int>(std::lround(off_color * static_cast<double>(depth) / color));
      if (isOdd() && depth > color) ++off_depth;  // less than one colour sample
      if (!isOdd()) return;
    }
  }
  [[nodiscard]] std::string explain() const {
    char line[160];
    std::snprintf(line, sizeof line,
                  "4:2:0 needs even sizes: cropped %d column and %d row of the colour, %d and %d of the depth",
                  color_cols, color_rows, depth_cols, depth_rows);
    return color_cols + color_rows + depth_cols + depth_rows == 0 ? "" : line;
  }
};

}  // namespace relievo
