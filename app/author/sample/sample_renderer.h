// SPDX-License-Identifier: Apache-2.0
// Pictures of the sample film: colour and exact depth, cast ray by ray on all cores.
#pragma once

#include <cstdint>
#include <vector>

namespace relievo {

struct SamplePicture {
  int cols = 0, rows = 0;
  std::vector<std::uint8_t> rgb;    // 3 bytes a pixel, sRGB transfer, BT.709 primaries
  std::vector<std::uint8_t> depth;  // 1 byte a pixel: round(255 height / 40 mm)
};

// The film at time t. The picture is sized by the caller through cols and rows; its buffers are kept from call to call.
void renderSample(double t_s, int threads, SamplePicture& picture);

}  // namespace relievo
