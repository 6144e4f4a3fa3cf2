// SPDX-License-Identifier: Apache-2.0
// Sums over whole blocks; incomplete ones are left out.
#include "app/enhance/shape_change.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relievo {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

// Calls block(c, r) with the first column and row of each whole block.
template <class Block>
void forBlocks(const DepthMap& map, Block&& block) {
  for (int r = 0; r + kShapeBlock <= map.rows; r += kShapeBlock) {
    for (int c = 0; c + kShapeBlock <= map.cols; c += kShapeBlock) block(c, r);
  }
}

float meanOf(const DepthMap& map, int c, int r) {
  float sum = 0;
  int holes = 0;
  for (int y = r; y < r + kShapeBlock; ++y) {
    const std::size_t first = map.at(c, y);
    for (std::size_t i = first; i < first + kShapeBlock; ++i) {
      sum += map.codes[i];
      holes += map.holes[i];
    }
  }
  return holes > 0 ? kNothing : sum / (kShapeBlock * kShapeBlock);
}

bool hasStep(const DepthMap& map, int c, int r) {
  float most = 0;
  for (int y = r; y < r + kShapeBlock; ++y) {
    for (int x = c; x < c + kShapeBlock; ++x) {
      const float code = map.codes[map.at(x, y)];
      if (x > c) most = std::max(most, std::abs(code - map.codes[map.at(x - 1, y)]));
      if (y > r) most = std::max(most, std::abs(code - map.codes[map.at(x, y - 1)]));
    }
  }
  return most > DepthMap::kStep;
}

}  // namespace

std::vector<float> blockMeans(const DepthMap& map) {
  std::vector<float> means;
  forBlocks(map, [&](int c, int r) { means.push_back(meanOf(map, c, r)); });
  return means;
}

float shapeChange(const std::vector<float>& means_before, const DepthMap& after) {
  double sum = 0;
  std::size_t block = 0, count = 0;
  forBlocks(after, [&](int c, int r) {
    const float change = meanOf(after, c, r) - means_before[block++];
    if (std::isnan(change) || hasStep(after, c, r)) return;
    sum += static_cast<double>(change) * static_cast<double>(change);
    ++count;
  });
  return count == 0 ? 0 : static_cast<float>(std::sqrt(sum / static_cast<double>(count)));
}

}  // namespace relievo
