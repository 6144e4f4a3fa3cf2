// SPDX-License-Identifier: Apache-2.0
// How far each contender's force is from the true one, by scene and kind of depth.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/lab/film/film_run.h"
#include "app/lab/measure/contenders.h"
#include "app/lab/numbers/statistics.h"
#include "platform/failure.h"

namespace relievo {

inline constexpr double kStiffnessNPerMm = MethodConfig{}.stiffness_n_per_mm;
inline constexpr double kSettledS = 0.3;  // after this part of a path the finger is in contact

inline constexpr std::array kDepthKinds{
    DepthKind{"16-bit", 16, 0, {}},
    DepthKind{"8-bit", 8, 0, {}},
    DepthKind{"H.264 crf 23", 8, 0, 23},
    DepthKind{"noise 1 %", 8, 0.01, {}},
};
inline constexpr const DepthKind& kEightBits = kDepthKinds[1];

// Sums the errors of the ticks from `from_s` on.
[[nodiscard]] ForceErrorSum forceErrors(std::span<const PlayedTick> ticks, double from_s);

// The smooth scenes in which stiffness x |dS/dt| stays below the scene's slew limit of 50 N/s: faster scenes are not
// judged by their force.
[[nodiscard]] std::vector<std::string_view> accuracyScenes();

struct AccuracyOptions {
  std::vector<std::string_view> scenes;
  double duration_s = 3;
};

struct AccuracyCell {
  ForceErrorSum sum;
  ContenderParts parts;
};
// [contender][kind of depth][scene], at 720x486 and 30 frames/s, finger 5 mm deep at 0.1 m/s.
using AccuracyTable = std::vector<std::array<std::vector<AccuracyCell>, kDepthKinds.size()>>;
[[nodiscard]] Outcome<AccuracyTable> measureAccuracy(std::span<const Contender> contenders,
                                                     const AccuracyOptions& options,
                                                     const std::function<void(const std::string&)>& tell);

}  // namespace relievo
