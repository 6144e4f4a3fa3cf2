// SPDX-License-Identifier: Apache-2.0
// A vector of four floats on any processor, by a vector extension that GCC and clang share.
#pragma once

#include <cstring>

#include "platform/realtime.h"

namespace relievo {

using Float4 = float __attribute__((vector_size(16)));

[[nodiscard]] inline Float4 load4(const float* p) RELIEVO_RT {
  Float4 v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

inline void store4(float* p, const Float4& v) RELIEVO_RT {
  std::memcpy(p, &v, sizeof v);
}

// The horizontal sums of a, b, c and d.
[[nodiscard]] inline Float4 sums(const Float4& a, const Float4& b, const Float4& c, const Float4& d) RELIEVO_RT {
  const Float4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Float4 cd = __builtin_shufflevector(c, d, 0, 4, 1, 5) + __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

}  // namespace relievo
