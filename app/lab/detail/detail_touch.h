// SPDX-License-Identifier: Apache-2.0
// The force on a finger that feels the triangles of a level of detail.
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
  double triangles = 0;  // of a picture, in the mean
};

// Each as the charts have it, finger 5 mm deep at 0.1 m/s on a nodding face for `duration_s`; of all of kDetails, in
// their order. `pixels_per_mm` as they are drawn.
[[nodiscard]] Outcome<std::vector<DetailTouch>> touchOfDetails(const DepthKind& depth, double pixels_per_mm,
                                                               double duration_s,
                                                               const std::function<void(const std::string&)>& tell);

}  // namespace relievo
