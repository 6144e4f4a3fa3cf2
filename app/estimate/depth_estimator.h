// SPDX-License-Identifier: Apache-2.0
// Interface of what estimates depth from one view: a command or a network. The depth is relative, without a unit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/scene/byte_picture.h"
#include "platform/failure.h"

namespace relievo {

struct RedGreenBlue {
  static constexpr std::size_t kCount = 3;
};
using RawPicture = BytePicture<RedGreenBlue>;

// Relative inverse depth, row by row: larger is nearer. Scale and offset may differ from picture to picture. It covers
// the whole picture that it was made from, whatever its size.
struct DepthEstimate {
  int cols = 0, rows = 0;
  std::vector<float> values;

  [[nodiscard]] std::size_t at(int c, int r) const noexcept { return static_cast<std::size_t>(r) * cols + c; }
};

// Returns one estimate for each picture, in order. It may need further pictures before it answers. Use from one thread.
// After a failure only its destructor may be called, which leaves nothing running.
class DepthEstimator {
 public:
  virtual ~DepthEstimator() = default;

  // The next picture; all of one size. May wait while the estimator is busy.
  [[nodiscard]] virtual Outcome<void> give(RawPicture picture) = 0;
  // Call after the last picture.
  virtual void end() = 0;
  // The next estimate; nullopt if more pictures are needed first, or all have been answered. After `end` it waits.
  [[nodiscard]] virtual Outcome<std::optional<DepthEstimate>> take() = 0;
};

}  // namespace relievo
