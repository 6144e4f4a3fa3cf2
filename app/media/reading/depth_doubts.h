// SPDX-License-Identifier: Apache-2.0
// Reasons why a film's reading is unlikely to be right.
#pragma once

#include <string>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

// One line each, with the share of samples and the option to try. `color`: the picture beside the depth, if it is one
// of its own; null if both are halves of one picture.
[[nodiscard]] std::vector<std::string> doubtsOf(const Frame& depth, const DepthCalibration& calibration,
                                                const Frame* color = nullptr);

// How much nearer the lower third of the relief is than the upper one, as a share of its depth: most views show a
// floor, a table or a road. Clearly if beyond kClearlyNearer. 0 if either third is holes.
inline constexpr double kClearlyNearer = 0.15;
[[nodiscard]] double nearerBelow(const Frame& depth, const DepthCalibration& calibration);

// The line for a near end that nobody has stated: which is taken, and the option for the other. `black`: the codes that
// are holes if near is dark; empty if none.
[[nodiscard]] std::string nearEndLine(const DepthCalibration& calibration, double nearer_below,
                                      const std::string& black);

}  // namespace relievo
