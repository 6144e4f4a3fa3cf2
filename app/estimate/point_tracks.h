// SPDX-License-Identifier: Apache-2.0
// Points that are followed from picture to picture, to a small part of a sample.
#pragma once

#include <vector>

#include "app/motion/motion_field.h"

namespace relievo {

struct TrackedPoint {
  double x = 0, y = 0;    // samples of the newest picture
  bool textured = false;  // its place is sure in both directions; else it goes with its block
  int age = 0;            // pictures since it was set
  int strays = 0;         // of the last pictures, those in which it did not go with the others
  double height = 0;      // the owner's
};

// About one point in each block of 8 x 8 samples. Each is moved by the blocks' motion and then fitted to its
// surroundings of 11 x 11 (Lucas and Kanade 1981), brighter or darker as they may be: so that the small errors of many
// pictures do not add up as quarters of a sample would.
class PointTracks {
 public:
  void clear() { points_.clear(); }
  // To the next picture; `motion`: motionBetween(before, now). Points that left it or look different are dropped.
  void follow(const GrayPicture& before, const GrayPicture& now, const std::vector<Motion>& motion);
  // New points, of age 0, where there are none.
  void seed(const GrayPicture& now);

  [[nodiscard]] std::vector<TrackedPoint>& points() noexcept { return points_; }
  [[nodiscard]] const std::vector<TrackedPoint>& points() const noexcept { return points_; }

 private:
  std::vector<TrackedPoint> points_;
};

}  // namespace relievo
