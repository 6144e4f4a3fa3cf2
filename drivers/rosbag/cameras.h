// SPDX-License-Identifier: Apache-2.0
// The position of the depth camera relative to the colour camera, from the bag's other messages.
#pragma once

#include <optional>
#include <string>

#include "drivers/rosbag/topics.h"

namespace relievo::rosbag {

// mm per code of a depth topic; nullopt if the bag does not say.
[[nodiscard]] std::optional<double> unitOf(BagFile& bag, const Topic& depth);

// Returns the TOML of app/media/registration/registration.h. Nullopt if the depth is in the colour's view already, or
// the bag does not state the cameras' relative position, or a lens has a model other than Brown-Conrady's or the
// rational one.
[[nodiscard]] std::optional<std::string> registrationOf(BagFile& bag, const Topic& depth, const Topic& color,
                                                        double unit_mm);

}  // namespace relievo::rosbag
