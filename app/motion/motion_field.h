// SPDX-License-Identifier: Apache-2.0
// How the things of one picture have moved since the one before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/scene/byte_picture.h"

namespace relievo {

struct Brightness {
  static constexpr std::size_t kCount = 1;
};
using GrayPicture = BytePicture<Brightness>;
// The mean of each `cols` x `rows` part; never larger than the picture.
[[nodiscard]] GrayPicture scaledTo(int cols, int rows, const std::uint8_t* codes, int width, int height);

struct Motion {
  float x = 0, y = 0;  // samples
  bool operator==(const Motion&) const = default;
};

// For each sample of `now` where it was in `before`, relative to its own place: the best vector of blocks of 8 x 8 by
// recursive search from coarse to fine (after de Haan 1993), in quarters of a sample; at each sample that of the near
// blocks' which fits best there, so that a thing's edge keeps to the thing. Both pictures have one size.
[[nodiscard]] std::vector<Motion> motionBetween(const GrayPicture& before, const GrayPicture& now);

// For each sample of `now` whether it has just come to light: the way there and back ends elsewhere, and the sample
// does not look like the one that it is said to be. `back`: motionBetween(now, before).
[[nodiscard]] std::vector<bool> uncovered(const GrayPicture& before, const GrayPicture& now,
                                          const std::vector<Motion>& motion, const std::vector<Motion>& back);

}  // namespace relievo
