// SPDX-License-Identifier: Apache-2.0
// Depth frames through a coder and back, in memory: what it leaves of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/coding/video_encoder.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

struct CodedDepth {
  std::vector<Frame> frames;  // the decoder's pictures by reference, in order, with the times of those that went in
  std::uint64_t bytes = 0;    // of all packets
};

// 4:0:0, signalled as full range, with a key frame at every second. Codec, bits, crf and what they are to be good for
// are the caller's, the rest of `settings` is the frames'. InvalidArgument for no frames, for other than gray frames of
// one size with that many bits, or for times that do not rise.
[[nodiscard]] Result<CodedDepth> codeDepth(std::span<const Frame> frames, VideoEncoder::Settings settings);
// As a coder does that knows nothing of touch: H.264, 8 bits; crf 0 is lossless, 51 the coarsest.
[[nodiscard]] Result<CodedDepth> codeDepth(std::span<const Frame> frames, int crf);

}  // namespace relievo
