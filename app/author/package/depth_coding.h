// SPDX-License-Identifier: Apache-2.0
// How the depth is to be written: its steps, its codec, and whether a decoder sees it as colour.
#pragma once

#include <cstdint>
#include <optional>

#include "app/coding/video_codec.h"
#include "app/scene/depth_calibration.h"

namespace relievo {

struct DepthCoding {
  VideoCodec codec = VideoCodec::H264;
  int bits = 8;
  // 4:2:0 with flat chroma, for hardware that knows no 4:0:0; its pictures have an even width and height.
  bool flat_chroma = false;
  // The codes' law; nothing: the source's. The heights stay, only where the steps are fine changes: evenly (linear), or
  // near the viewer (inverse, by the source's near and far).
  std::optional<DepthLaw> law;
  int crf = 8;  // 0: lossless, every code comes back
};

}  // namespace relievo
