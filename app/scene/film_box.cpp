// SPDX-License-Identifier: Apache-2.0
#include "app/scene/film_box.h"

namespace relievo {

double shapeOf(const Frame& picture) noexcept {
  return picture.width * picture.sample_aspect / picture.height;
}

bool hasShapeOfDepth(const Frame& color, const Frame& depth) noexcept {
  const auto isSquare = [](const Frame& picture) { return shapeOf(picture) == 1; };
  return !depth.empty() && isSquare(color) && !isSquare(depth);
}

DisplayVolume usualBox(const Frame& color, const Frame& depth) noexcept {
  const Frame& picture = hasShapeOfDepth(color, depth) ? depth : color;
  return DisplayVolume::forPicture(picture.width, picture.height, picture.sample_aspect);
}

}  // namespace relievo
