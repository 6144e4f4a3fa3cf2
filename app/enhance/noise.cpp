// SPDX-License-Identifier: Apache-2.0
// Immerkaer, Fast Noise Variance Estimation (1996), with the median instead of the mean, since edges are outliers.
#include "app/enhance/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace relievo {

float noiseOf(const DepthMap& map) {
  // The mask is the product of 1 -2 1 across and down: noise s gives a response of standard deviation 6 s. The median
  // magnitude of a normal distribution is 0.6745 standard deviations.
  constexpr float kPerCode = 6 * 0.6745F;
  // A subset of the rows is enough. A histogram of the responses interpolates the median, which would otherwise be a
  // whole number for small codes.
  constexpr int kBins = 4096;
  constexpr float kBinsPerCode = 1.0F / 8;
  std::array<std::size_t, kBins> bins{};
  std::size_t count = 0;
  constexpr int kRowsEnough = 160;
  const int every = std::max(map.rows / kRowsEnough, 1);
  std::vector<float> responses(map.cols);
  for (int r = 1; r + 1 < map.rows; r += every) {
    const float* const z = map.codes.data() + map.at(0, r);
    const std::uint8_t* const hole = map.holes.data() + map.at(0, r);
    const std::ptrdiff_t up = -map.cols, down = map.cols;
    for (int c = 1; c + 1 < map.cols; ++c) {
      const auto bend = [&](std::ptrdiff_t i) { return z[i - 1] - 2 * z[i] + z[i + 1]; };
      const auto holes = [&](std::ptrdiff_t i) { return hole[i - 1] | hole[i] | hole[i + 1]; };
      const float response = std::abs(bend(c + up) - 2 * bend(c) + bend(c + down));
      responses[c] = (holes(c + up) | holes(c) | holes(c + down)) != 0 ? -1 : response;
    }
    for (int c = 1; c + 1 < map.cols; ++c) {
      if (responses[c] < 0) continue;
      ++bins[static_cast<std::size_t>(std::min(responses[c] * kBinsPerCode, kBins - 1.0F))];
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
