// SPDX-License-Identifier: Apache-2.0
// The difference between a part of one picture and a part of another, at distances in quarters of a sample.
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

// A picture interpolated at each quarter of a sample to the right and down. Each is made on demand, once, with the
// border samples repeated beyond the edge.
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

// The part of `now` from (left, top) to before (right, bottom), within the picture, compared with a part of `before` at
// a distance. Returns the sum of differences, or any sum above `most`. Border samples of `before` are repeated.
struct PicturePart {
  int left, top, right, bottom;
};
[[nodiscard]] int differenceOf(const QuarterPictures& before, const GrayPicture& now, const PicturePart& part,
                               const Motion& v, int most);

}  // namespace relievo
