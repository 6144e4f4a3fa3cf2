// SPDX-License-Identifier: Apache-2.0
// Converts the triangles drawn at a level of detail back to a depth picture, so that a finger can feel the same
// triangles that are seen.
#pragma once

#include <cstddef>

#include "app/lab/detail/drawn_level.h"
#include "app/scene/display_volume.h"
#include "app/scene/height_field.h"
#include "hal/media/frame.h"

namespace relievo {

struct DrawnDepth {
  Frame frame;  // 16 bits, linear, near high, full range; as many samples as the depth that was drawn
  std::size_t triangles = 0;
};

// `field`, which must have no holes, as it is drawn in `volume` at `level`, on views of `pixels_per_mm`. A cell that is
// cut at a silhouette keeps the heights of its samples.
[[nodiscard]] DrawnDepth drawnDepth(const HeightField& field, const DisplayVolume& volume, const DrawnLevel& level,
                                    double pixels_per_mm);

}  // namespace relievo
