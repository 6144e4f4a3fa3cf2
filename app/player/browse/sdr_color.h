// SPDX-License-Identifier: Apache-2.0
// Colours of HDR pictures as a usual screen shows them.
#pragma once

#include <cstdint>

#include "app/media/reading/picture_look.h"

namespace relievo {

// `transfer` and `primaries` as in a Frame. PQ and HLG become gamma 2.4, BT.2020 becomes BT.709. HDR's reference white,
// 203 cd/m2, is a little below white, and what is brighter, up to 1000 cd/m2, is compressed into the rest. Colours with
// another transfer are returned as they are. Pure.
[[nodiscard]] PictureColor asSdr(const PictureColor& color, std::uint8_t transfer, std::uint8_t primaries) noexcept;

}  // namespace relievo
