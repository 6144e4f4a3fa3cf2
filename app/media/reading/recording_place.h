// SPDX-License-Identifier: Apache-2.0
// What the names of a recording's files and folders, the files beside it and the tags of other programs tell about its
// depth.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/media/reading/known_kind.h"
#include "app/media/reading/stereo/stereo_camera.h"

namespace relievo {

// The settings hold only what was found; `why` is one line, empty if nothing was found.
struct RecordingPlace {
  const KnownKind* kind = nullptr;
  CalibrationOrigin origin = CalibrationOrigin::Name;  // of the kind
  CalibrationSettings settings;                        // read from a file or a tag: near, far, unit
  std::string why;
  std::string file;                    // beside it, that this was read from; empty: none
  std::optional<StereoCamera> camera;  // of disparities; calib.txt
};

// Looks at `depth_url`, or at `url` if that is empty; addresses of networks and devices tell nothing. Reads small files
// only: a camera's JSON, Depthkit's, calib.txt.
[[nodiscard]] RecordingPlace lookAtPlace(const std::string& url, const std::string& depth_url);
// A JSON text among the container's tags (Record3D).
[[nodiscard]] RecordingPlace lookAtTags(const std::map<std::string, std::string>& tags);

}  // namespace relievo
