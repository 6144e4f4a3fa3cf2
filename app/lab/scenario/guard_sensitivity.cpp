// SPDX-License-Identifier: Apache-2.0
// One challenger for each threshold.
#include "app/lab/scenario/guard_sensitivity.h"

#include <algorithm>
#include <array>

#include "app/haptics/baseline/triangle_proxy.h"
#include "app/lab/scenario/verdict_table.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::array kThresholdsN{0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 0.0};  // 0: no guard

std::string thresholdName(double threshold_n) {
  return threshold_n > 0 ? print("%g", threshold_n) : "off";
}

Challenger guardedAt(double threshold_n) {
  return {thresholdName(threshold_n), [=](double stiffness, std::span<const TimedSurface>) {
            return std::make_unique<TriangleProxy>(stiffness,
                                                   TriangleParts{Walk::Graph, TimeLaw::Linear, true, threshold_n});
          }};
}

}  // namespace

Outcome<ChartWords> measureGuardSensitivity(const MeasureOptions& options) {
  std::vector<Challenger> challengers;
  challengers.reserve(kThresholdsN.size());
  for (const double threshold : kThresholdsN) challengers.push_back(guardedAt(threshold));
  const VerdictTable table(challengers, options);
  if (const auto written = table.write(options.out + "/guard-sensitivity.csv", "threshold_n"); !written)
    return std::unexpected(written.error());
  std::string passed;
  std::size_t best = 0;
  for (std::size_t i = 0; i < kThresholdsN.size(); ++i) {
    passed += print("%s %s %zu", i > 0 ? "," : "", challengers[i].name.c_str(), table.passed(i));
    if (table.passed(i) > table.passed(best)) best = i;
  }
  return ChartWords{
      "The paper's guard against force jumps, by its threshold",
      print("Scenarios of %zu that modified-proxy-graph passes, by threshold in N:%s. The map of methods "
            "uses %g N. A threshold below the best (%s) "
            "takes fast fingers, missed ticks and late frames for jumps of the scene.",
            scenarios().size(), passed.c_str(), TriangleProxy::kJumpThresholdN, challengers[best].name.c_str())};
}

}  // namespace relievo
