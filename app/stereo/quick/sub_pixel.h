// SPDX-License-Identifier: Apache-2.0
// Refines disparities that are right to a pixel to a small fraction of one.
#pragma once

#include <cstdint>
#include <vector>

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// Least squares on the brightness around each pixel (Lucas and Kanade 1981), only along the row. Before it and after
// each round, each disparity becomes the mean of its neighbours on the same surface, so that a slope has no terraces.
// Keeps its memory.
class SubPixel {
 public:
  // The map must be as large as the views. Pixels that were not seen, and those without texture, keep their disparity.
  void refine(DisparityMap& map, const ViewPicture& left, const ViewPicture& right);

 private:
  void compare(const DisparityMap& map, int r);
  void step(DisparityMap& map);
  void smooth(DisparityMap& map, bool across, float surface);

  std::vector<float> left_, right_;
  std::vector<float> slopes_, misfits_;                // sums of squares of the slope, and of slope times misfit
  std::vector<float> column_slopes_, column_misfits_;  // kReach more on each side
  std::vector<float> smoothed_;
  std::vector<float> shown_, slopes_there_, told_;  // of a row, in the right view; told_: 1 or 0
  std::vector<float> slope_sums_, misfit_sums_;     // of a row
};

}  // namespace relievo
