// SPDX-License-Identifier: Apache-2.0
// Immerkaer, Fast Noise Variance Estimation (1996), with the median for the mean: edges are outliers.
#include "app/enhance/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relievo {

float noiseOf(const DepthMap& map) {
  // The mask's weights are 1 -2 1 times 1 -2 1: of noise s it makes 6 s. Half of a normal distribution lies within
  // 0.6745 of its standard deviation.
  constexpr float kPerCode = 6 * 0.6745F;
  // The responses in a histogram: whole numbers of small codes would make the median itself one of few numbers.
  constexpr int kBins = 4096;
  constexpr float kBinsPerCode = 1.0F / 8;
  std::array<std::size_t, kBins> bins{};
  std::size_t count = 0;
  for (int r = 1; r + 1 < map.rows; ++r) {
    for (int c = 1; c + 1 < map.cols; ++c) {
      float response = 0;
      int holes = 0;
      for (int d = -1; d <= 1; ++d) {
        const std::size_t i = map.at(c, r + d);
        const float across = map.codes[i - 1] - 2 * map.codes[i] + map.codes[i + 1];
        response += d == 0 ? -2 * across : across;
        holes += map.holes[i - 1] + map.holes[i] + map.holes[i + 1];
      }
      if (holes > 0) continue;
      ++bins[static_cast<std::size_t>(std::min(std::abs(response) * kBinsPerCode, kBins - 1.0F))];
      ++count;
    }
  }
  if (count == 0) return 0;
  std::size_t below = 0;
  std::size_t bin = 0;
  while (below + bins[bin] < (count + 1) / 2) below += bins[bin++];
  return bin == 0 ? 0 : (static_cast<float>(bin) + 0.5F) / kBinsPerCode / kPerCode;
}

}  // namespace relievo
