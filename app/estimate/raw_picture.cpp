// SPDX-License-Identifier: Apache-2.0
#include "app/estimate/raw_picture.h"

#include <algorithm>
#include <cmath>

#include "app/scene/color/color_shares.h"

namespace relievo {

RawPicture rawOf(const Frame& frame) {
  RawPicture picture(frame.width, frame.height);
  std::uint8_t* out = picture.bytes.data();
  const ColorShares shares(frame);
  for (int r = 0; r < frame.height; ++r) {
    for (int c = 0; c < frame.width; ++c) {
      for (const double share : shares.at(c, r)) {
        *out++ = static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
      }
    }
  }
  return picture;
}

}  // namespace relievo
