// SPDX-License-Identifier: Apache-2.0
// How to encode the depth: spacing of its steps, codec, bits, quality, chroma.
#pragma once

#include <cstdint>
#include <optional>

#include "app/coding/video_codec.h"
#include "app/scene/depth_calibration.h"

namespace relievo {

struct DepthCoding {
  VideoCodec codec = VideoCodec::H264;
  int bits = 8;
  // 4:2:0 with flat chroma, for hardware that cannot decode 4:0:0; needs an even width and height.
  bool flat_chroma = false;
  // The law of the codes; nullopt: the source's. Heights do not change, only where the steps are finest: evenly spaced
  // (linear), or near the viewer (inverse, with the source's near and far).
  std::optional<DepthLaw> law;
  int crf = 8;  // 0: lossless

  [[nodiscard]] bool isLossless() const noexcept { return codec == VideoCodec::Ffv1 || crf == 0; }
};

}  // namespace relievo
