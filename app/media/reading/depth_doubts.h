// SPDX-License-Identifier: Apache-2.0
// Reasons why a film's reading is unlikely to be right.
#pragma once

#include <string>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

// A tag of relievo-author's films: how it read their depth.
inline constexpr const char* kReadAsTag = "DEPTH_READ_AS";

// One line each, with the share of samples and the option to try. `color`: the picture beside the depth, if it is one
// of its own; null if both are halves of one picture. `by_author`: a film of relievo-author, which shows depth without
// colour as gray, and has told whether the two are otherwise alike.
[[nodiscard]] std::vector<std::string> doubtsOf(const Frame& depth, const DepthCalibration& calibration,
                                                const Frame* color = nullptr, bool by_author = false);

// True if nearly all of the relief is one code, or it is all holes: no end of it is near.
[[nodiscard]] bool isLevel(const Frame& depth, const DepthCalibration& calibration);

// How much nearer the lower third of the relief is than the upper one, as a share of its depth: most views show a
// floor, a table or a road. Clearly if beyond kClearlyNearer. 0 if either third is holes.
inline constexpr double kClearlyNearer = 0.15;
[[nodiscard]] double nearerBelow(const Frame& depth, const DepthCalibration& calibration);

// The line for a near end that nobody has stated: which is taken, and the option for the other. `black`: the codes that
// are holes if near is dark; empty if none.
[[nodiscard]] std::string nearEndLine(const DepthCalibration& calibration, double nearer_below,
                                      const std::string& black);

}  // namespace relievo
