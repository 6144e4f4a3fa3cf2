// SPDX-License-Identifier: Apache-2.0
// Reads red, green and blue of any picture.
#include "app/author/material/painted_map.h"

#include <algorithm>
#include <cmath>

#include "app/scene/color/color_shares.h"

namespace relievo {
namespace {

std::uint8_t codeOf(double share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

bool isOpaque(const Frame& picture, int c, int r) {
  return !picture.alpha || codeAt(picture, *picture.alpha, c, r) >= 0.5 * ((1U << picture.alpha->bits) - 1);
}

}  // namespace

PaintedMap readMap(const Frame& picture, int cols, int rows) {
  PaintedMap map{.cols = cols, .rows = rows, .codes = {}, .painted = {}};
  const ColorShares shares(picture);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const int x = (2 * c + 1) * picture.width / (2 * cols), y = (2 * r + 1) * picture.height / (2 * rows);
      const auto [red, green, blue] = shares.at(x, y);
      const PaintedMap::Codes all{codeOf(red), codeOf(green), codeOf(blue)};
      map.codes.push_back(picture.model == ColorModel::Gray ? PaintedMap::Codes{all[0]} : all);  // gray: stiffness
      map.painted.push_back(isOpaque(picture, x, y));
    }
  }
  return map;
}

}  // namespace relievo
