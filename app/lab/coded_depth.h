// SPDX-License-Identifier: Apache-2.0
// Depth frames through H.264 and back, in memory: what a coder of a given quality leaves of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

struct CodedDepth {
  std::vector<Frame> frames;  // the decoder's pictures by reference, in order, with the times of those that went in
  std::uint64_t bytes = 0;    // of all packets
};

// libx264, 4:0:0, 8 bits, signalled as full range, default preset; crf 0 is lossless, 51 the coarsest. InvalidArgument
// for no frames, for other than 8-bit gray frames of one size, or for times that do not rise.
[[nodiscard]] Result<CodedDepth> codeDepth(std::span<const Frame> frames, int crf);

}  // namespace relievo
