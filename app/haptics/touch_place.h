// SPDX-License-Identifier: Apache-2.0
// Where in a picture there is something to touch: for a hand that has no eyes.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "app/scene/height_field.h"

namespace relievo {

// The place nearest to the picture's middle, in scene mm, at which a fingertip meets surface all around and no hole.
// Nothing where there is none. Not the real-time thread: reads some ten thousand samples at most.
[[nodiscard]] std::optional<glm::dvec2> placeToTouch(const HeightField& field);

}  // namespace relievo
