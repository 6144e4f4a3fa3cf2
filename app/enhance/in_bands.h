// SPDX-License-Identifier: Apache-2.0
// Works on a picture's rows on all cores.
#pragma once

#include <algorithm>
#include <opencv2/core/utility.hpp>

namespace relievo {

inline constexpr int kBandRows = 32;  // rows

// Calls work(first, end) for bands of rows, several at once on OpenCV's threads. The bands do not depend on the number
// of threads, so results computed from a whole band do not either.
template <class Work>
void inBands(int rows, Work&& work) {
  cv::parallel_for_(cv::Range(0, (rows + kBandRows - 1) / kBandRows), [&](const cv::Range& bands) {
    for (int band = bands.start; band < bands.end; ++band)
      work(band * kBandRows, std::min((band + 1) * kBandRows, rows));
  });
}

}  // namespace relievo
