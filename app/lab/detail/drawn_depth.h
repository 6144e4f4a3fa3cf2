// SPDX-License-Identifier: Apache-2.0
// The relief as it is drawn at a level of detail, made a depth picture again: what a finger would feel that felt the
// same triangles as are seen.
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

// `field`, without holes, as it is drawn in `volume` at `level`, on views of `pixels_per_mm`. A cell that is cut
// keeps the heights of its samples.
[[nodiscard]] DrawnDepth drawnDepth(const HeightField& field, const DisplayVolume& volume, const DrawnLevel& level,
                                    double pixels_per_mm);

}  // namespace relievo
