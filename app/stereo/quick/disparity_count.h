// SPDX-License-Identifier: Apache-2.0
// How the disparities of a shot are spread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// Disparities of the textured pixels by their counts, in quarters of a pixel. What is matched elsewhere is chance: the
// black around a title would have the widest range.
class DisparityCount {
 public:
  // `widest`: the largest disparity, in pixels.
  explicit DisparityCount(int widest);
  // `left`: the view that was matched.
  void add(const DisparityMap& map, const ViewPicture& left);
  // The share of the textured pixels that both views show; none if there are too few to tell it from chance.
  [[nodiscard]] double found() const noexcept;
  // The disparities between which all but this share lie, at each end.
  struct Reach {
    double low = 0, high = 0;
  };
  [[nodiscard]] Reach reach(double outliers) const noexcept;
  // True if nine tenths lie within so many pixels of zero, as those of two copies of one picture do: a codec and noise
  // shift a sample by less than half a pixel.
  [[nodiscard]] bool isNone(double most) const noexcept;

 private:
  [[nodiscard]] double below(double share) const noexcept;

  int widest_;
  std::vector<std::uint64_t> counts_;
  std::uint64_t all_ = 0, textured_ = 0, pixels_ = 0;
};

}  // namespace relievo
