// SPDX-License-Identifier: Apache-2.0
// Finds relief so fine that a wide smoothing would flatten it.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "app/depth_window/surface_window.h"

namespace relievo {

// Sizes of the blocks that are compared; waves of two to six blocks are found. The smallest ones only tell waves from
// what a codec leaves.
inline constexpr std::array kWaveBlocksMm{1.55, 2.2, 3.1};
inline constexpr double kShareOfPlaces = 0.6;
using Waves = std::array<double, kWaveBlocksMm.size()>;
// Larger ones, for what a broad smoothing would flatten.
inline constexpr std::array kSwellBlocksMm{4.4, 6.2, 8.8};
using Swells = std::array<double, kSwellBlocksMm.size()>;

// For each size the fourth difference of the means of five blocks in a row, in mm, that kShareOfPlaces of the places do
// not exceed, across or down, whichever is greater: 0 on every surface of the third order. The means are over all
// frames. What codes of `step_mm` or noise may have made does not count: a difference between blocks that bend by a
// step at most, and what differs as much from frame to frame as noise does, which is of `noise_mm` a sample at least;
// `still`: the same in all frames. Nor do blocks with a hole or at an end of the range. Reads seventy thousand samples
// of each frame for each size.
[[nodiscard]] Waves wavesOf(std::span<const TimedSurface> frames, double step_mm, double noise_mm, bool still);

// The same for the larger blocks, less only what noise makes on average. What codes may have made counts unless the
// steps are farther apart than the blocks, `terrace_mm` on average: a narrower terrace is averaged away by a block.
[[nodiscard]] Swells swellsOf(std::span<const TimedSurface> frames, double step_mm, double terrace_mm, double noise_mm,
                              bool still);

[[nodiscard]] inline double greatest(const Waves& waves) {
  return *std::max_element(waves.begin() + 1, waves.end());
}
// What the smallest blocks differ by beyond waves: a codec's traces, in mm.
[[nodiscard]] double tracesAmong(const Waves& waves);
// Whether they grow with the blocks as a relief's do; what a codec leaves is about a step in blocks of any size.
[[nodiscard]] bool grow(const Waves& waves, double step_mm);
// The error in the slope of a surface with such waves that smoothing of a width leaves.
[[nodiscard]] double flattenedBy(double width_mm, const Waves& waves);
[[nodiscard]] double swellsFlattenedBy(double width_mm, const Swells& swells);

}  // namespace relievo
