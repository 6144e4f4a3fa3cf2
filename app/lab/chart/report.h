// SPDX-License-Identifier: Apache-2.0
// One page over all charts.
#pragma once

#include <string>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Runs every measurement that lacks a chart in the folder, or has one of a quick run where this one is not, or the
// other way round. Then writes FOLDER/index.html: each chart with its title, its reading, a link to its figures, and
// the machine and the day on which it was measured. Failed measurements are reported at the end; the page is still
// written with the other charts. A chart that cannot be written, as on a full disk, ends the report at once.
[[nodiscard]] Outcome<void> writeReport(const MeasureOptions& options);

}  // namespace relievo
