// SPDX-License-Identifier: Apache-2.0
// How unlike a part of one picture is to the part of another that lies a quarter, or many, of a sample aside.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "app/motion/motion_field.h"

namespace relievo {

// Square parts of these sizes are compared quickly.
inline constexpr int kLargePart = 12, kSmallPart = 5;

// A picture as it is between its samples, at each quarter of one to the right and down: made where it is asked for,
// once, with its last samples going on beyond its edge.
class QuarterPictures {
 public:
  explicit QuarterPictures(GrayPicture picture) : picture_(std::move(picture)) {}
  [[nodiscard]] const GrayPicture& picture() const noexcept { return picture_; }
  // At `fx`, `fy` quarters, kEdge samples wider on each side.
  [[nodiscard]] const GrayPicture& at(int fx, int fy) const;
  static constexpr int kEdge = 32;

 private:
  [[nodiscard]] GrayPicture between(int fx, int fy) const;
  // One sample more than a row that is made.
  [[nodiscard]] std::vector<std::uint8_t> wideRow(int row) const;

  GrayPicture picture_;
  mutable std::array<GrayPicture, 16> made_;
};

// The part of `now` from (left, top) to before (right, bottom), within the picture, as one of `before` at a distance:
// the sum of the differences, or a sum above `most`. Beyond the last samples of `before` they go on.
struct PicturePart {
  int left, top, right, bottom;
};
[[nodiscard]] int differenceOf(const QuarterPictures& before, const GrayPicture& now, const PicturePart& part,
                               const Motion& v, int most);

}  // namespace relievo
