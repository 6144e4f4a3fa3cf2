// SPDX-License-Identifier: Apache-2.0
// What a picture looks like: gray, vivid or a photo; and which of its halves is depth.
#pragma once

#include <optional>
#include <string>

#include "app/media/reading/packing.h"
#include "hal/frame.h"

namespace relievo {

// Of some ten thousand samples, evenly spread. Shares are from 0 to 1.
struct PictureLook {
  double gray = 0;   // share of samples without colour
  double vivid = 0;  // share of samples, among those that are not dark, whose colour is as strong as it can be
  double dark = 0;
  double spread = 0;  // standard deviation of the brightness, of full scale
};
// Any thread.
[[nodiscard]] PictureLook lookAt(const Frame& picture) noexcept;

// Nearly every sample that is lit is of a pure colour: depth that is coded as a hue, or as a colour map.
[[nodiscard]] bool isHue(const PictureLook& look) noexcept;

struct FoundPacking {
  Packing packing = Packing::Tracks;
  DepthCode code = DepthCode::Luma;
  std::string why;  // one line
};
// Colour and depth in the two halves of one picture: one half is a photo and the other one has no colour at all, or
// nothing but the strongest colours, which are hues. Nothing where the halves do not differ so clearly.
[[nodiscard]] std::optional<FoundPacking> findPacking(const Frame& picture);

}  // namespace relievo
