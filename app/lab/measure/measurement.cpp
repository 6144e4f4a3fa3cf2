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
constexpr std::array kStabilityCharts{"stability", "guard-sensitivity", "stability-onset"};
constexpr std::array kDetailCharts{"detail"};
constexpr std::array kEnhanceCharts{"enhance", "enhance-points"};
constexpr std::array kBitrateCharts{"bitrate"};

constexpr std::array kMeasurements{
    Measurement{"speed-accuracy", "time of a tick against the error of the force, by method and parts",
                kSpeedAccuracyCharts, measureSpeedAndAccuracy},
    Measurement{"edges", "error of the felt surface at edges, by smoothing width and kind of depth", kEdgesCharts,
                measureEdges},
    Measurement{"smoothness", "spectrum of the force on a moving face, and its peak at the frame rate",
                kSmoothnessCharts, measureSmoothness},
    Measurement{"stability",
                "every method in scenarios where methods fail, and the stiffness at which closed loops oscillate",
                kStabilityCharts, measureStability},
    Measurement{"detail", "cost of the drawn relief by level of detail, against the errors of picture and touch",
                kDetailCharts, measureDetail},
    Measurement{"enhance", "effect of depth enhancement on force and edges, and the points that a mesh needs",
                kEnhanceCharts, measureEnhancement},
    Measurement{"bitrate", "bit rate of the depth by codec, bits and quality, against the error of the force",
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
