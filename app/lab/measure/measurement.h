// SPDX-License-Identifier: Apache-2.0
// The measurements behind the charts: the files that each writes, and how it is run.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/lab/chart/chart.h"
#include "app/media/pair_reader.h"
#include "hal/display.h"
#include "platform/failure.h"

namespace relievo {

struct MeasureOptions {
  std::string out;                       // an existing folder
  bool quick = false;                    // fewer scenes, rounds and seconds: within a minute on two processors
  Display* display = nullptr;            // off screen, not opened yet; for measurements that draw
  std::vector<std::string> depth_films;  // recorded depth, for the measurements that use it
  PairReader::Backends backends;         // to open depth_films with
  std::function<void(const std::string&)> tell = [](const std::string&) {
  };  // called with the present step in a few words
};

// FOLDER/NAME.svg, drawn from FOLDER/NAME.csv.
struct ChartEntry {
  const char* name;
  const char* better;  // where in the chart the better results lie
};

struct Measurement {
  const char* name;  // the command: relievo-lab NAME
  const char* about;
  std::span<const ChartEntry> charts;
  // Writes every CSV before the first chart is drawn, so that the figures exist even without gnuplot. Returns the
  // charts' words in the order of `charts`.
  Outcome<std::vector<ChartWords>> (*measure)(const MeasureOptions& options);
};

// All of them, in the order of the report.
[[nodiscard]] std::span<const Measurement> measurements();

// Measures and draws.
[[nodiscard]] Outcome<void> runMeasurement(const Measurement& measurement, const MeasureOptions& options);

}  // namespace relievo
