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
inline constexpr const char* kAllScenes = "all";  // all scenes put together
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

  // True if both rows measured the same thing, whatever the figures.
  [[nodiscard]] bool sameKind(const SpeedAccuracyRow& other) const;
  // True for a row that compares scenes, false for one that compares times.
  [[nodiscard]] bool isAccuracy() const {
    return sameKind(SpeedAccuracyRow{.who = who, .depth = depth, .scene = scene});
  }
};

struct SpeedAccuracyFigures {
  std::vector<SpeedAccuracyRow> rows;  // no two of the same kind
  int clock_ns = 0;                    // the cost of one clock reading, which was subtracted

  // The row of this kind; null if it was not measured.
  [[nodiscard]] SpeedAccuracyRow* find(const SpeedAccuracyRow& kind);
  [[nodiscard]] const SpeedAccuracyRow* find(const SpeedAccuracyRow& kind) const;
};

// One CSV per chart: speed-accuracy, accuracy-by-scene, parts, tick-time.
[[nodiscard]] Outcome<void> writeTables(const SpeedAccuracyFigures& figures, const std::string& folder);
// In the same order. Needs the rows of all contenders on 720x486 at both 0.1 and 1 m/s.
[[nodiscard]] std::vector<ChartWords> chartWords(const SpeedAccuracyFigures& figures);

}  // namespace relievo
