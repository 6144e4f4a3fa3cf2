// SPDX-License-Identifier: Apache-2.0
// The list of measurements.
#include "app/lab/measure/measurement.h"

#include <array>

#include "app/lab/chart/occasion.h"
#include "app/lab/detail/detail.h"
#include "app/lab/measure/bitrate.h"
#include "app/lab/measure/edges.h"
#include "app/lab/measure/enhance.h"
#include "app/lab/measure/latency.h"
#include "app/lab/measure/smoothness.h"
#include "app/lab/measure/speed_accuracy.h"
#include "app/lab/measure/stereo.h"
#include "app/lab/measure/widths.h"
#include "app/lab/scenario/material_stability.h"
#include "app/lab/scenario/stability.h"

namespace relievo {
namespace {

constexpr std::array kSpeedAccuracyCharts{
    ChartEntry{"speed-accuracy", "lower left"},
    ChartEntry{"accuracy-by-scene", "lower"},
    ChartEntry{"parts", "to the left"},
    ChartEntry{"tick-time", "lower"},
};
constexpr std::array kWidthsCharts{ChartEntry{"widths", "lower"}};
constexpr std::array kEdgesCharts{ChartEntry{"edges", "lower"}};
constexpr std::array kSmoothnessCharts{
    ChartEntry{"smoothness", "lower"},
    ChartEntry{"smoothness-hand", "lower"},
    ChartEntry{"smoothness-peaks", "lower right"},
};
constexpr std::array kLatencyCharts{ChartEntry{"latency", "to the left; lower for the errors, higher for the tremor"}};
constexpr std::array kStabilityCharts{
    ChartEntry{"stability", "a row without a failure"},
    ChartEntry{"guard-sensitivity", "a row without a failure"},
    ChartEntry{"stability-onset", "higher"},
};
constexpr std::array kMaterialCharts{ChartEntry{"stability-material", "a row without a failure"}};
constexpr std::array kDetailCharts{ChartEntry{"detail", "to the left; higher for PSNR, lower for the force error"}};
constexpr std::array kEnhanceCharts{ChartEntry{"enhance", "lower"}, ChartEntry{"enhance-points", "lower left"}};
constexpr std::array kBitrateCharts{ChartEntry{"bitrate", "lower left"}};
constexpr std::array kStereoCharts{ChartEntry{"stereo", "lower left"}};

constexpr std::array kMeasurements{
    Measurement{"speed-accuracy", "time of a tick against the error of the force, by method and parts",
                kSpeedAccuracyCharts, measureSpeedAndAccuracy},
    Measurement{"widths",
                "error of relievo beside that of depth smoothed per frame with one width, over a range of widths",
                kWidthsCharts, measureWidths},
    Measurement{"edges", "error of the felt surface at edges, by smoothing width and kind of depth", kEdgesCharts,
                measureEdges},
    Measurement{"smoothness", "spectrum of the force on a moving face, and its peak at the frame rate",
                kSmoothnessCharts, measureSmoothness},
    Measurement{"latency", "age of a live film's felt surface against the error of the force and the tremor",
                kLatencyCharts, measureLatency},
    Measurement{"stability",
                "every method in scenarios where methods fail, and the stiffness at which closed loops oscillate",
                kStabilityCharts, measureStability},
    Measurement{"stability-material",
                "relievo in the scenarios of `stability`, on surfaces with friction, softer, stiffer, textured",
                kMaterialCharts, measureMaterialStability},
    Measurement{"detail", "cost of the drawn relief by level of detail, against the errors of picture and touch",
                kDetailCharts, measureDetail},
    Measurement{"enhance", "effect of depth enhancement on force and edges, and the points that a mesh needs",
                kEnhanceCharts, measureEnhancement},
    Measurement{"bitrate", "bit rate of the depth by codec, bits and quality, against the error of the force",
                kBitrateCharts, measureBitrate},
    Measurement{"stereo", "time to make depth from two views against the error of the force, by matcher and film",
                kStereoCharts, measureStereo},
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
    const auto& [name, better] = measurement.charts[i];
    own.tell(std::string("drawing ") + name);
    const ChartWords& told = words->at(i);
    const ChartWords whole{told.title, told.reading + " Better: " + better + ".", occasionNow(options.quick)};
    if (auto drawn = drawChart(options.out, name, whole); !drawn) return drawn;
  }
  return {};
}

}  // namespace relievo
