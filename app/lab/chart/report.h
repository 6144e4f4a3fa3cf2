// SPDX-License-Identifier: Apache-2.0
// One page over all charts.
#pragma once

#include <string>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Runs every measurement of which a chart is missing in the folder, then writes FOLDER/index.html: each chart with its
// title, its reading and a link to its figures; the machine and the day. A measurement that fails is told at the end,
// the page is written over the others all the same.
[[nodiscard]] Outcome<void> writeReport(const MeasureOptions& options);

}  // namespace relievo
