// SPDX-License-Identifier: Apache-2.0
// The registration that a recording brings along.
#pragma once

#include <optional>
#include <string_view>

#include "app/media/registration/registration.h"
#include "hal/media/media_source.h"

namespace relievo {

// Where the depth track's tag DEPTH_REGISTRATION holds the TOML of a registration, that one; of an Azure Kinect's or a
// Femto's recording the one in its attachment calibration.json. Nullopt if there is none, or it cannot be used.
[[nodiscard]] std::optional<Registration> ownRegistration(const MediaSource& source, const StreamInfo& color,
                                                          const StreamInfo& depth);

// The attachment's text, for pictures of these sizes in pixels. Nullopt if it is damaged, or the sizes or the lens
// model are none of that camera's.
struct ModeSize {
  int cols = 0, rows = 0;
};
[[nodiscard]] std::optional<Registration> parseKinectCalibration(std::string_view json, ModeSize depth, ModeSize color);

}  // namespace relievo
