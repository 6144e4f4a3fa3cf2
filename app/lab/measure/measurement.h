// SPDX-License-Identifier: Apache-2.0
// The measurements that end in charts: what each leaves in its folder, and how it is run.
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
  std::string out;                       // a folder that is there
  bool quick = false;                    // fewer scenes, rounds and seconds: within a minute on two processors
  Display* display = nullptr;            // off screen, not opened yet; for measurements that draw
  std::vector<std::string> depth_films;  // real depth, for those who look at it too
  PairReader::Backends backends;         // to open depth_films with
  std::function<void(const std::string&)> tell = [](const std::string&) {};  // what it is at, in a few words
};

// FOLDER/NAME.svg, drawn from FOLDER/NAME.csv.
struct ChartEntry {
  const char* name;
  const char* better;  // where in the chart the better results are
};

struct Measurement {
  const char* name;  // the command: relievo-lab NAME
  const char* about;
  std::span<const ChartEntry> charts;
  // Writes every CSV before the first chart is drawn, so that the figures are there without gnuplot too. Answers the
  // charts' words in the order of `charts`.
  Outcome<std::vector<ChartWords>> (*measure)(const MeasureOptions& options);
};

// All of them, in the order of the report.
[[nodiscard]] std::span<const Measurement> measurements();

// Measures and draws.
[[nodiscard]] Outcome<void> runMeasurement(const Measurement& measurement, const MeasureOptions& options);

}  // namespace relievo
