// SPDX-License-Identifier: Apache-2.0
// Televisions that were sold, as Linux users recorded them: facts of https://github.com/linuxhw/EDID (CC BY 4.0), read
// by its authors and here with edid-decode, not by this project. Modes of 720 rows and more.
//
// The kernel (drm_edid.c, do_hdmi_vsdb_modes) adds to what a television lists the signals that each must take
// (mandatoryTelevision in television_modes.h), and of side by side lists halves taken horizontally alone.
#pragma once

#include "tests/support/device/card/television_modes.h"

namespace relievo::test {

// Digital/Sony/SNY2C02/0EA8A9488CD4, "SONY TV", 2011. Both halves for its first seven modes; frame packing of 1080 rows
// also at 30 Hz.
inline std::vector<drmModeModeInfo> sonyTelevision() {
  return TelevisionModes()
      .plain({31, 16, 20, 5, 19, 4, 32, 34, 60, 62}, 16)
      .stereo(DRM_MODE_FLAG_3D_FRAME_PACKING, {32, 19, 4, 20, 5, 34, 60, 62})
      .stereo(DRM_MODE_FLAG_3D_TOP_AND_BOTTOM, {31, 16, 20, 5, 19, 4, 32, 34})
      .stereo(DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF, {31, 16, 20, 5, 19, 4, 32})
      .listed();
}
// Digital/Samsung/SAM0B60/14E843304DCE, "SAMSUNG", 2013. Both halves for all of its modes; frame packing also at 25 and
// 30 Hz.
inline std::vector<drmModeModeInfo> samsungTelevision() {
  return TelevisionModes()
      .plain({16, 31, 4, 19, 5, 20, 32, 33, 34}, 16)
      .stereo(DRM_MODE_FLAG_3D_FRAME_PACKING, {32, 4, 19, 5, 20, 33, 34})
      .stereo(DRM_MODE_FLAG_3D_TOP_AND_BOTTOM, {16, 31, 4, 19, 5, 20, 32, 33, 34})
      .stereo(DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF, {16, 31, 4, 19, 5, 20, 32, 33, 34})
      .listed();
}
// Digital/Goldstar/GSM0001/04A493D92AC6, "LG TV RVU", 2016. No mode of 50 Hz.
inline std::vector<drmModeModeInfo> lgTelevision() {
  return TelevisionModes()
      .plain({16, 4, 5, 32, 34}, 16)
      .stereo(DRM_MODE_FLAG_3D_FRAME_PACKING, {32, 4})
      .stereo(DRM_MODE_FLAG_3D_TOP_AND_BOTTOM, {32, 4, 5, 34})
      .stereo(DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF, {5, 4, 32, 34})
      .listed();
}
// Digital/Panasonic/MEIA296/05885BD70F27, "Panasonic-TV", 2017, of 2160 rows. At 50 and 60 Hz of 1080 rows it takes
// side by side in any way of halving, which the kernel does not list.
inline std::vector<drmModeModeInfo> panasonicTelevision() {
  return TelevisionModes()
      .plain({16, 31, 5, 20, 32, 33, 34, 4, 19, 93, 94, 95, 97, 96}, 97)
      .stereo(DRM_MODE_FLAG_3D_FRAME_PACKING, {5, 20, 32, 4, 19})
      .stereo(DRM_MODE_FLAG_3D_TOP_AND_BOTTOM, {5, 20, 32, 4, 19, 16, 31})
      .stereo(DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF, {5, 20, 32, 4, 19})
      .listed();
}

}  // namespace relievo::test
