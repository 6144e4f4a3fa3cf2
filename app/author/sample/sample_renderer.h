// SPDX-License-Identifier: Apache-2.0
// Renders pictures of the sample film: colour and exact depth, by ray casting on all cores.
#pragma once

#include <cstdint>
#include <vector>

namespace relievo {

struct SamplePicture {
  int cols = 0, rows = 0;
  std::vector<std::uint8_t> rgb;    // 3 bytes per pixel, sRGB transfer, BT.709 primaries
  std::vector<std::uint8_t> depth;  // 1 byte per pixel: round(255 height / 40 mm)
};

// Renders the film at time t. The caller sets cols and rows; the buffers are reused from call to call.
void renderSample(double t_s, int threads, SamplePicture& picture);

}  // namespace relievo
