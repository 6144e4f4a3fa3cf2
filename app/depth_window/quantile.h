// SPDX-License-Identifier: Apache-2.0
// The quantile of a list of measurements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace relievo {

// The value that a share of the list does not exceed; 0 if the list is empty. Changes the order.
[[nodiscard]] inline double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace relievo
