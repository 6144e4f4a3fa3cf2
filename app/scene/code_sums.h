// SPDX-License-Identifier: Apache-2.0
// Sums of raw codes over the samples of a block.
#pragma once

#include <cstddef>
#include <cstdint>

#include "platform/realtime.h"

namespace relievo {

// Samples of a plane, evenly spaced. Does not own them.
struct CodeBlock {
  const std::uint8_t* first = nullptr;
  std::ptrdiff_t step_bytes = 1, stride_bytes = 0;  // from one sample to the next, across and down
  int across = 1, down = 1;
};

// Codes of one byte.
[[nodiscard]] std::uint32_t sumOfBytes(const CodeBlock& block) RELIEVO_RT;
// Codes of two bytes, the low one first; `mask` is laid over each.
[[nodiscard]] std::uint32_t sumOfWords(const CodeBlock& block, std::uint32_t mask) RELIEVO_RT;

}  // namespace relievo
