// SPDX-License-Identifier: Apache-2.0
// Semi-global matching that is quick enough to run while a film plays; it needs no library.
#pragma once

#include <cstdint>
#include <vector>

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// Census of 5 x 5 pixels (Zabih and Woodfill, ECCV 1994), whatever the exposure; paths in four directions
// (Hirschmueller, PAMI 2008). Keeps its memory from picture to picture.
class QuickMatching {
 public:
  // The views have one size, row by row. `seen`: the right view has the same point there, and it is no speckle. Other
  // pixels keep the left view's match; `from_right` is -infinity where nothing was found.
  [[nodiscard]] const DisparityMap& match(const ViewPicture& left, const ViewPicture& right, DisparityRange range);

 private:
  using Census = std::vector<std::uint32_t>;
  using Cost = std::int16_t;

  void prepare(const ViewPicture& left, DisparityRange range);
  void takeCensus(const std::vector<std::uint8_t>& luma, Census& census) const;
  void costsOfRow(int r);
  void downward();
  void upward();
  void alongRow(int r, int step);
  void fromRowBefore(int r, bool first);
  void chooseInRow(int r);
  void checkRow(int r);
  void removeSpecks();
  [[nodiscard]] std::size_t wanted() const noexcept {
    const int count = range_.highest - range_.lowest + 1;
    return static_cast<std::size_t>(count);
  }
  [[nodiscard]] std::size_t cell(int c, int r) const noexcept { return map_.at(c, r) * levels_; }

  DisparityMap map_;
  DisparityRange range_;
  std::size_t levels_ = 0;  // a multiple of a vector's length
  std::vector<std::uint8_t> left_luma_, right_luma_;
  Census left_census_, right_census_, reversed_;
  std::vector<std::uint8_t> costs_;  // of all pixels and disparities
  std::vector<Cost> sums_;           // likewise, of the paths
  std::vector<Cost> before_, now_;   // a row's and a pixel's paths
  std::vector<Cost> least_right_;
  std::vector<std::size_t> speck_;  // pixels
  std::vector<std::uint8_t> visited_;
  int last_row_ = 0;  // of the sweep
};

}  // namespace relievo
