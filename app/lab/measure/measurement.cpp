// SPDX-License-Identifier: Apache-2.0
// The list of measurements.
#include "app/lab/measure/measurement.h"

#include <array>

#include "app/lab/detail/detail.h"
#include "app/lab/measure/bitrate.h"
#include "app/lab/measure/edges.h"
#include "app/lab/measure/enhance.h"
#include "app/lab/measure/smoothness.h"
#include "app/lab/measure/speed_accuracy.h"
#include "app/lab/scenario/stability.h"

namespace relievo {
namespace {

constexpr std::array kSpeedAccuracyCharts{"speed-accuracy", "accuracy-by-scene", "parts", "tick-time"};
constexpr std::array kEdgesCharts{"edges"};
constexpr std::array kSmoothnessCharts{"smoothness", "smoothness-hand", "smoothness-peaks"};
constexpr std::array kStabilityCharts{"stability", "stability-onset"};
constexpr std::array kDetailCharts{"detail"};
constexpr std::array kEnhanceCharts{"enhance", "enhance-points"};
constexpr std::array kBitrateCharts{"bitrate"};

constexpr std::array kMeasurements{
    Measurement{"speed-accuracy", "what a tick takes and how far the force is from the true one, by method and parts",
                kSpeedAccuracyCharts, measureSpeedAndAccuracy},
    Measurement{"edges", "what smoothing costs at an edge, by width and kind of depth", kEdgesCharts, measureEdges},
    Measurement{"smoothness", "the force's spectrum on a moving face, and what of it is the frame rate",
                kSmoothnessCharts, measureSmoothness},
    Measurement{"stability", "every method where methods fail, and where closed loops begin to swing", kStabilityCharts,
                measureStability},
    Measurement{"detail", "what a level of detail of the drawn relief costs, and how far picture and touch are off",
                kDetailCharts, measureDetail},
    Measurement{"enhance", "what enhancement of a camera's depth does for force and edges, and what a mesh takes",
                kEnhanceCharts, measureEnhancement},
    Measurement{"bitrate", "what the depth's codec, bits and quality cost, and how far the force is off with them",
                kBitrateCharts, measureBitrate},
};

}  // namespace

std::span<const Measurement> measurements() {
  return kMeasurements;
}

Outcome<void> runMeasurement(const Measurement& measurement, const MeasureOptions& options) {
  MeasureOptions own = options;
  own.tell = [&](const std::string& what) { options.tell(std::string(measurement.name) + ": " + what); };
  const auto words = measurement.measure(own);
  if (!words) return std::unexpected(words.error());
  for (std::size_t i = 0; i < measurement.charts.size(); ++i) {
    const std::string name = measurement.charts[i];
    own.tell("drawing " + name);
    if (auto drawn = drawChart(options.out, name, words->at(i)); !drawn) return drawn;
  }
  return {};
}

}  // namespace relievo
