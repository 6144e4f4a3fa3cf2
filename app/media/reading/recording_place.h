// SPDX-License-Identifier: Apache-2.0
// Finds a recording's kind and depth parameters from the names of its files and folders, the files beside it and other
// programs' tags.
#pragma once

#include <map>
#include <memory>
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
  std::string file;                                // the file beside it that this was read from; empty: none
  std::optional<StereoCamera> camera;              // of disparities; calib.txt
  std::shared_ptr<const KnownKind> own = nullptr;  // `kind`, if the file beside it says how its codes are stored
};

// Examines `depth_url`, or `url` if that is empty; for addresses of networks and devices nothing is found. Reads only
// small files: a camera's JSON, Depthkit's, LeRobot's, calib.txt. `layout`: the depth's kLayoutTag, which says more
// than words in the path.
[[nodiscard]] RecordingPlace lookAtPlace(const std::string& url, const std::string& depth_url,
                                         const std::string& layout = "");
// Reads a JSON text among the container's tags (Record3D).
[[nodiscard]] RecordingPlace lookAtTags(const std::map<std::string, std::string>& tags);

}  // namespace relievo
