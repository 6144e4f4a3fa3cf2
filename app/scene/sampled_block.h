// SPDX-License-Identifier: Apache-2.0
// Which samples of a block stand for all of them.
#pragma once

#include "platform/realtime.h"

namespace relievo {

// Which samples of a block are averaged: about `most` across and as many down, evenly spaced and centred, or all of
// them if there are no more. If they were off centre by half a sample, the mean of a slope would be wrong by half a
// sample's rise. Lengths are in samples; `most` is at least 1.
//
// Where whole rows are read as quickly as a few samples of them, a block is read in few whole rows: about as many
// samples, in fewer cache lines.
struct SampledBlock {
  struct Places {
    int count = 1, step = 1, first = 0;
    Places() = default;
    Places(int length, int most) RELIEVO_RT;
  };
  int width = 1, height = 1;
  Places across, down;

  SampledBlock() = default;
  SampledBlock(int block_width, int block_height, int most) RELIEVO_RT : width(block_width),
                                                                         height(block_height),
                                                                         across(block_width, most),
                                                                         down(block_height, most) {}
  // Of a block of whole rows: fewer would hit the same height of the steps on too many slopes. A row of a wide block
  // crosses more steps by itself.
  [[nodiscard]] static constexpr int fewestRows(double block_width) RELIEVO_RT { return block_width < 64 ? 6 : 4; }
  [[nodiscard]] static SampledBlock ofWholeRows(int block_width, int block_height, int most) RELIEVO_RT;
};

}  // namespace relievo
