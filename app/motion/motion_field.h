// SPDX-License-Identifier: Apache-2.0
// Estimates the motion of objects from one picture to the next.
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

// For each sample of `now`, its position in `before` relative to its own: the best vector of blocks of 8 x 8 by
// recursive search from coarse to fine (after de Haan 1993), in quarters of a sample. Each sample gets, of the nearby
// blocks' vectors, the one that fits best there, so that an object's edge moves with the object. Both pictures have one
// size.
[[nodiscard]] std::vector<Motion> motionBetween(const GrayPicture& before, const GrayPicture& now);

// For each sample of `now`, true if it has just been uncovered: its motion there and back does not return to it, and it
// does not look like the sample that it is said to come from. `back`: motionBetween(now, before).
[[nodiscard]] std::vector<bool> uncovered(const GrayPicture& before, const GrayPicture& now,
                                          const std::vector<Motion>& motion, const std::vector<Motion>& back);

}  // namespace relievo
