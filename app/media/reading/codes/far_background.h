// SPDX-License-Identifier: Apache-2.0
// The background of rendered distances: one code far behind all others.
#pragma once

#include <optional>

#include "app/media/reading/code_count.h"
#include "app/media/reading/depth_reading.h"
#include "app/scene/codes/code_set.h"
#include "app/scene/depth_calibration.h"

namespace relievo {

// A renderer's sky or far plane, as 16-bit codes of distances: a share of the samples that is alone beyond a gap which
// is wider than the range of all others, at twice their distance at least. As a distance it would press the shape into
// a small part of the box. Nullopt if there is none. For distances only: in brightness one far shade is usual.
[[nodiscard]] std::optional<CodeSet::Range> farBackground(const CodeCount& count);

// Makes the codes of the background holes, whichever of `layers` and `read` says which other codes are, and says so.
void leaveOut(const CodeSet::Range& background, const CodeCount& count, CalibrationLayers& layers, DepthReading& read);

}  // namespace relievo
