// SPDX-License-Identifier: Apache-2.0
// Classifies a picture as gray, vivid or photographic, and finds which of its halves is depth.
#pragma once

#include <optional>
#include <string>

#include "app/media/reading/packing.h"
#include "hal/frame.h"

namespace relievo {

// Statistics of about ten thousand evenly spaced samples. Shares are 0 to 1.
struct PictureLook {
  double gray = 0;   // share of samples without colour
  double vivid = 0;  // share of the samples that are not dark whose colour is fully saturated
  double dark = 0;
  double spread = 0;  // standard deviation of the brightness, as a share of full scale
};
// Any thread.
[[nodiscard]] PictureLook lookAt(const Frame& picture) noexcept;

// True if nearly every lit sample has a pure colour: depth coded as a hue, or through a colour map.
[[nodiscard]] bool isHue(const PictureLook& look) noexcept;

struct FoundPacking {
  Packing packing = Packing::Tracks;
  DepthCode code = DepthCode::Luma;
  std::string why;  // one line
};
// Finds colour and depth in the two halves of one picture: one half is a photo, the other is gray or consists of pure
// hues. Nullopt if the halves do not differ that clearly.
[[nodiscard]] std::optional<FoundPacking> findPacking(const Frame& picture);

}  // namespace relievo
