// SPDX-License-Identifier: Apache-2.0
// The error of the force on a finger that feels the triangles of a level of detail.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "app/lab/detail/detail_tables.h"
#include "platform/failure.h"

namespace relievo {

struct DetailTouch {
  std::array<ForceError, kDetailFeltBy.size()> errors;
  double triangles = 0;  // per picture, on average
};

// The finger is 5 mm deep, at 0.1 m/s, on a nodding face for `duration_s`. One result for each of kDetails, in that
// order. `pixels_per_mm` as the levels are drawn.
[[nodiscard]] Outcome<std::vector<DetailTouch>> touchOfDetails(const DepthKind& depth, double pixels_per_mm,
                                                               double duration_s,
                                                               const std::function<void(const std::string&)>& tell);

}  // namespace relievo
