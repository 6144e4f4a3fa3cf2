// SPDX-License-Identifier: Apache-2.0
// What guesses depth from one view: a command or a network. Nothing here says how far anything is.
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

// Relative inverse depth, row by row: larger is nearer. Scale and offset may differ from picture to picture. It shows
// the whole picture that it was made from, whatever its size.
struct DepthEstimate {
  int cols = 0, rows = 0;
  std::vector<float> values;

  [[nodiscard]] std::size_t at(int c, int r) const noexcept { return static_cast<std::size_t>(r) * cols + c; }
};

// One estimate for each picture, in their order. It may be late: it wants further pictures before it answers. Use from
// one thread. After a failure only its destructor may be called, which leaves nothing running.
class DepthEstimator {
 public:
  virtual ~DepthEstimator() = default;

  // The next picture; all of one size. May wait while the estimator is busy.
  [[nodiscard]] virtual Outcome<void> give(RawPicture picture) = 0;
  // There are no more pictures.
  virtual void end() = 0;
  // The next estimate; nullopt if it wants more pictures first, or has answered all. After `end` it waits for them.
  [[nodiscard]] virtual Outcome<std::optional<DepthEstimate>> take() = 0;
};

}  // namespace relievo
