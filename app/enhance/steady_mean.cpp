// SPDX-License-Identifier: Apache-2.0
// One pass over all the pictures at once.
#include "app/enhance/steady_mean.h"

#include <algorithm>
#include <cmath>

#include "app/enhance/in_bands.h"

namespace relievo {

void steadyMean(const DepthMap& present, std::span<const DepthMap* const> before,
                std::span<const DepthMap* const> after, float alike, std::span<float> mean) {
  inBands(present.rows, [&](int first, int end) {
    for (std::size_t i = present.at(0, first); i < present.at(0, end); ++i) {
      float sum = present.codes[i], count = 1;
      for (std::size_t k = 0; present.holes[i] == 0 && k < before.size(); ++k) {
        const float earlier = before[k]->codes[i], later = after[k]->codes[i], both = earlier + later;
        const bool known = (before[k]->holes[i] | after[k]->holes[i]) == 0;
        if (!known || std::abs(0.5F * both - present.codes[i]) > alike) continue;
        sum += both;
        count += 2;
      }
      mean[i] = sum / count;
    }
  });
}

}  // namespace relievo
