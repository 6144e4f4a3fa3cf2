// SPDX-License-Identifier: Apache-2.0
// Classifies a picture as gray, vivid or photographic, and finds which of its halves is depth.
#pragma once

#include <optional>
#include <string>

#include "app/media/reading/packing.h"
#include "hal/media/frame.h"

namespace relievo {

// Red, green and blue, each 0 to 1.
struct PictureColor {
  double red = 0, green = 0, blue = 0;
};
// The colour of a sample, in the primaries and transfer of the picture.
[[nodiscard]] PictureColor colorAt(const Frame& picture, int c, int r) noexcept;

// Statistics of about ten thousand evenly spaced samples. Shares are 0 to 1.
struct PictureLook {
  double gray = 0;   // share of samples without colour
  double vivid = 0;  // share of the samples that are not dark whose colour is fully saturated
  double dark = 0;
  double red = 0;     // share of the samples that are not dark that are red alone, of any brightness
  double pale = 0;    // share of the samples that are not dark and less than nine tenths bright
  double spread = 0;  // standard deviation of the brightness, as a share of full scale
};
// Any thread.
[[nodiscard]] PictureLook lookAt(const Frame& picture) noexcept;

// The picture at a quarter of its size, each sample the mean of sixteen: colours that a small palette mixes become what
// they are mixed to.
[[nodiscard]] Frame meansOf(const Frame& picture);

// True if nearly every lit sample has a pure colour: depth coded as a hue, or through a colour map.
[[nodiscard]] bool isHue(const PictureLook& look) noexcept;
// True if the picture is one of red shades: brightness in the red component alone.
[[nodiscard]] bool isRedAlone(const PictureLook& look) noexcept;
// True if it is dark or uniform, as before a fade-in or behind a lens cap: it shows nothing.
[[nodiscard]] bool isBlank(const Frame& picture) noexcept;

struct AlphaLook {
  int shades = 0;
  double between = 0;  // share of the samples that are neither transparent nor opaque
};
// Nullopt if the picture has no alpha channel.
[[nodiscard]] std::optional<AlphaLook> lookAtAlpha(const Frame& picture);
// True if it varies as depth does; a matte is transparent or opaque nearly everywhere.
[[nodiscard]] bool isAlphaDepth(const AlphaLook& look) noexcept;

// Whether the two halves of the picture meet in a step: the brightness changes far more across the middle than beside
// it.
[[nodiscard]] bool breaksInTheMiddle(const Frame& picture, bool side_by_side) noexcept;

// The white columns in the middle of the picture that part two halves, as Depth Anything's films have them; 0 if there
// are none.
[[nodiscard]] int whiteSeam(const Frame& picture) noexcept;

struct FoundPacking {
  Packing packing = Packing::Tracks;
  DepthCode code = DepthCode::Luma;
  GrayFrom gray = GrayFrom::Luma;
  std::string why;   // one line
  std::string note;  // what to do with a film that shows a third picture too, one line; empty if it does not
};
// Finds colour and depth in the two halves of one picture: one half is a photo, the other is gray or consists of pure
// hues. Nullopt if the halves do not differ that clearly.
[[nodiscard]] std::optional<FoundPacking> findPacking(const Frame& picture);

}  // namespace relievo
