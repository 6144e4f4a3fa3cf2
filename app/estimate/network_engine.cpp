// SPDX-License-Identifier: Apache-2.0
#include "app/estimate/network_engine.h"

#include <algorithm>

namespace relievo {

NetworkPlanes planesOfOutput(std::span<const std::int64_t> shape, const float* values) {
  constexpr std::int64_t kMost = 1 << 14;
  const bool plane = (shape.size() == 3 || (shape.size() == 4 && shape[1] == 1)) && shape[0] == 1;
  if (!plane || std::ranges::any_of(shape, [](std::int64_t n) { return n < 1 || n > kMost; })) return {};
  const int cols = static_cast<int>(shape.back()), rows = static_cast<int>(shape[shape.size() - 2]);
  return {cols, rows, {values, values + static_cast<std::ptrdiff_t>(cols) * rows}};
}

std::string inOneLine(const std::string& words) {
  return words.substr(0, std::min<std::size_t>(words.find('\n'), 120));
}

}  // namespace relievo
