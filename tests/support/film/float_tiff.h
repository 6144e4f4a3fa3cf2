// SPDX-License-Identifier: Apache-2.0
// TIFF pictures of floats, for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace relievo::test {

struct FloatTiff {
  std::uint32_t width = 64, height = 48;
  std::vector<float> samples;       // row by row
  std::uint16_t compression = 1;    // of libtiff: COMPRESSION_NONE, ..
  std::uint16_t predictor = 1;      // PREDICTOR_NONE, ..
  std::uint32_t tile = 0;           // its side; 0: in strips of 7 rows
  std::uint16_t sample_format = 3;  // SAMPLEFORMAT_IEEEFP
};

// Throws std::runtime_error when it cannot be written. A page is added to the file that is there.
void writeFloatTiff(const std::string& path, const FloatTiff& picture);
void addFloatPage(const std::string& path, const FloatTiff& picture);

}  // namespace relievo::test
