// SPDX-License-Identifier: Apache-2.0
// Evenly spaced and centred places along a length.
#include "app/scene/codes/sampled_block.h"

#include <algorithm>

namespace relievo {

SampledBlock::Places::Places(int length, int most) RELIEVO_RT : count(length) {
  if (length <= most) return;
  count = most + ((length ^ most) & 1);  // same parity as the length
  step = length / count;
  if (count % 2 == 0 && step % 2 == 0) {  // the length is even too: a centred place needs an odd step
    ++step;
    while (step * (count - 1) >= length) count -= 2;
  }
  first = (length - 1 - step * (count - 1)) / 2;
}

SampledBlock SampledBlock::ofWholeRows(int block_width, int block_height, int most) RELIEVO_RT {
  const int rows = std::max(std::min(most, fewestRows(block_width)), (most * most + block_width - 1) / block_width);
  SampledBlock block(block_width, block_height, rows);
  block.across = Places(block_width, block_width);
  return block;
}

}  // namespace relievo
