// SPDX-License-Identifier: Apache-2.0
// Describes two cameras side by side, read from a file beside their disparities, and converts disparities to distances.
#pragma once

#include <filesystem>
#include <optional>

#include "app/media/reading/depth_reading.h"

namespace relievo {

// A disparity of d pixels lies at baseline_mm * focal_px / (d + offset_px).
struct StereoCamera {
  double focal_px = 0, baseline_mm = 0;
  double offset_px = 0;        // between the principal points
  double width_px = 0;         // of the pictures that these are for; 0: unknown
  double least = 0, most = 0;  // disparities in use; 0: unknown
};

// Middlebury's calib.txt ("cam0=[f 0 cx; 0 f cy; 0 0 1]", doffs, baseline, width, vmin, vmax). Nullopt if the file is
// missing or lacks focal length or baseline.
[[nodiscard]] std::optional<StereoCamera> stereoCameraIn(const std::filesystem::path& file);

// The cameras of Middlebury's pictures of 2005 and 2006: 3740 pixels, 160 mm apart. Their codes are pixels of the full
// size, whatever the pictures' size, less the number in `dmin_file`, if there is one.
[[nodiscard]] StereoCamera stereoCameraOf2006(const std::filesystem::path& dmin_file);

// The range of the codes in use and its distances. Codes that were not made from floats are pixels, or 1/256 pixel if
// whole pixels would exceed the camera's largest disparity.
[[nodiscard]] DepthReading readDisparities(const Frame& depth, const CodeCount& count, const StereoCamera& camera);

}  // namespace relievo
