// SPDX-License-Identifier: Apache-2.0
// Selects the samples of a block that represent all of them.
#pragma once

#include "platform/realtime.h"

namespace relievo {

// Which samples of a block are averaged: about `most` across and as many down, evenly spaced and centred, or all of
// them if there are no more. If they were off centre by half a sample, the mean of a slope would be wrong by half a
// sample's rise. Lengths are in samples; `most` is at least 1.
//
// If reading whole rows is as quick as reading a few of their samples, few whole rows of a block are read: about as
// many samples, in fewer cache lines.
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
  // For a block of whole rows: with fewer rows, too many slopes would be sampled at the same height of the depth's
  // steps. A row of a wide block crosses more steps by itself.
  [[nodiscard]] static constexpr int fewestRows(double block_width) RELIEVO_RT { return block_width < 64 ? 6 : 4; }
  [[nodiscard]] static SampledBlock ofWholeRows(int block_width, int block_height, int most) RELIEVO_RT;
};

}  // namespace relievo
