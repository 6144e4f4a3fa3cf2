// SPDX-License-Identifier: Apache-2.0
// The quantile of a list of measurements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace relievo {

// The value that a share of the list does not exceed; 0 if the list is empty. Changes the order.
template <class T>
[[nodiscard]] T quantile(std::vector<T>& values, double share) {
  if (values.empty()) return T{};
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace relievo
