// SPDX-License-Identifier: Apache-2.0
#include "app/scene/sampled_block.h"

namespace relievo {

SampledBlock::Places::Places(int length, int most) RELIEVO_RT : count(length) {
  if (length <= most) return;
  count = most + ((length ^ most) & 1);  // same parity as the length
  step = length / count;
  if (count % 2 == 0 && step % 2 == 0) step += (step + 1) * (count - 1) < length ? 1 : -1;
  first = (length - 1 - step * (count - 1)) / 2;
}

}  // namespace relievo
