// SPDX-License-Identifier: Apache-2.0
#include "app/scene/codes/depth_code.h"

namespace relievo {

const char* name(DepthCode code) noexcept {
  static constexpr std::array kNames{"luma",    "hue",    "turbo",   "jet",      "inferno", "magma",
                                     "viridis", "plasma", "rainbow", "spectral", "kinect",  "ylgnbu"};
  static_assert(kNames.size() == kDepthCodes.size());
  return kNames.at(static_cast<std::size_t>(code));
}

}  // namespace relievo
