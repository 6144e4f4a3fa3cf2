// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/enhance/depth_map.h"

namespace relievo::test {

// A map whose code at (column, row) is code(c, r), without holes.
template <class Code>
DepthMap mapOf(int cols, int rows, Code&& code) {
  DepthMap map(cols, rows);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) map.codes[map.at(c, r)] = static_cast<float>(code(c, r));
  }
  return map;
}

}  // namespace relievo::test
