// SPDX-License-Identifier: Apache-2.0
// How the paper's method fares with other thresholds of its guard (IV-C), for which the paper gives no figure.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// Writes guard-sensitivity.csv: `modified-proxy-graph` in all scenarios at thresholds from 0.25 to 8 N and without the
// guard.
[[nodiscard]] Outcome<ChartWords> measureGuardSensitivity(const MeasureOptions& options);

}  // namespace relievo
