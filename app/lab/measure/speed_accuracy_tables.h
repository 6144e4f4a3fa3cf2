// SPDX-License-Identifier: Apache-2.0
// The figures of speed and accuracy as tables and words.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/lab/chart/chart.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/measure/tick_timing.h"

namespace relievo {

inline constexpr const char* kTimedScene = "face-nodding";
inline constexpr const char* kAllScenes = "all";  // put together
inline constexpr double kSlowMPerS = 0.1;

struct PictureSize {
  int cols = 720, rows = 486;
  bool operator==(const PictureSize&) const = default;
};

struct SpeedAccuracyRow {
  const Contender* who = nullptr;
  const DepthKind* depth = &kEightBits;
  std::string scene = kTimedScene;
  PictureSize size;
  double speed_m_per_s = kSlowMPerS;
  bool cold = false;
  ContenderParts parts;  // empty over all scenes: the plan picks for each film
  std::optional<ForceError> error;
  std::optional<TickTimes> times;

  // What was measured is the same, whatever it came to.
  [[nodiscard]] bool sameKind(const SpeedAccuracyRow& other) const;
  // It is one of the rows in which the scenes are compared, not one of those in which times are.
  [[nodiscard]] bool isAccuracy() const {
    return sameKind(SpeedAccuracyRow{.who = who, .depth = depth, .scene = scene});
  }
};

struct SpeedAccuracyFigures {
  std::vector<SpeedAccuracyRow> rows;  // no two of the same kind
  int clock_ns = 0;                    // what a reading of the clock costs; taken off

  // The row of a kind; null when it was not measured.
  [[nodiscard]] SpeedAccuracyRow* find(const SpeedAccuracyRow& kind);
  [[nodiscard]] const SpeedAccuracyRow* find(const SpeedAccuracyRow& kind) const;
};

// One CSV per chart: speed-accuracy, accuracy-by-scene, parts, tick-time.
[[nodiscard]] Outcome<void> writeTables(const SpeedAccuracyFigures& figures, const std::string& folder);
// In the same order. Needs the rows of all contenders on 720x486 at both 0.1 and 1 m/s.
[[nodiscard]] std::vector<ChartWords> chartWords(const SpeedAccuracyFigures& figures);

}  // namespace relievo
