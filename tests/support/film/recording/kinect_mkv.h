// SPDX-License-Identifier: Apache-2.0
// Matroska files as Azure Kinect's recorder writes them, element by element, for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace relievo::test {

struct KinectTrack {
  std::string name;    // COLOR, DEPTH, IR
  std::string fourcc;  // "b16g", "NV12", ..
  int cols = 0, rows = 0;
  std::uint16_t bits = 16;            // of a pixel
  std::vector<std::string> pictures;  // their bytes
};

// A picture of each track every 1/30 s, to the microsecond. Without an attachment if `calibration` is empty.
[[nodiscard]] std::string kinectMkv(const std::vector<KinectTrack>& tracks, const std::string& calibration);

}  // namespace relievo::test
