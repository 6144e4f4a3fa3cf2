// SPDX-License-Identifier: Apache-2.0
// Encodes and decodes depth frames in memory, to measure what a codec does to them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/coding/video_encoder.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

struct CodedDepth {
  std::vector<Frame> frames;  // decoded pictures, in order, with the timestamps of the input
  std::uint64_t bytes = 0;    // of all packets
};

// Encodes gray as 4:0:0, signalled as full range, and YUV as 4:2:0, with a key frame every second. The caller chooses
// codec, bits, crf and tuning; the other settings come from the frames. InvalidArgument if there are no frames, if they
// are not gray or 4:2:0 frames of one size with that bit depth, or if their timestamps do not increase.
[[nodiscard]] Result<CodedDepth> codeDepth(std::span<const Frame> frames, VideoEncoder::Settings settings);
// The same with an encoder that is not tuned for touch: H.264, 8 bits; crf 0 is lossless, 51 the coarsest.
[[nodiscard]] Result<CodedDepth> codeDepth(std::span<const Frame> frames, int crf);

}  // namespace relievo
