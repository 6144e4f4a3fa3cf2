// SPDX-License-Identifier: Apache-2.0
// The registration that a recording contains.
#pragma once

#include <optional>
#include <string_view>

#include "app/media/registration/registration.h"
#include "hal/media/media_source.h"

namespace relievo {

// Reads the depth track's tag DEPTH_REGISTRATION, which holds the TOML of a registration, or the attachment
// calibration.json of an Azure Kinect's or a Femto's recording. Nullopt if there is none, or it cannot be used.
[[nodiscard]] std::optional<Registration> ownRegistration(const MediaSource& source, const StreamInfo& color,
                                                          const StreamInfo& depth);

// Reads the attachment's text, for pictures of these sizes in pixels. Nullopt if it is damaged, or if the sizes or the
// lens model are not that camera's.
struct ModeSize {
  int cols = 0, rows = 0;
};
[[nodiscard]] std::optional<Registration> parseKinectCalibration(std::string_view json, ModeSize depth, ModeSize color);

}  // namespace relievo
