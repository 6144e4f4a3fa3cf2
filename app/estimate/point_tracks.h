// SPDX-License-Identifier: Apache-2.0
// Tracks points from picture to picture, to a small part of a sample.
#pragma once

#include <vector>

#include "app/motion/motion_field.h"

namespace relievo {

struct TrackedPoint {
  double x = 0, y = 0;    // samples of the newest picture
  bool textured = false;  // its position is well determined in both directions; else it moves with its block
  int age = 0;            // pictures since it was added
  int strays = 0;         // number of the last pictures in which its motion differed from the others'
  double height = 0;      // set by the owner
};

// Keeps about one point in each block of 8 x 8 samples. Each is moved by the blocks' motion and then fitted to its
// surroundings of 11 x 11 (Lucas and Kanade 1981), allowing for a change of brightness. The fit keeps the error over
// many pictures smaller than quarter-sample motion alone would.
class PointTracks {
 public:
  void clear() { points_.clear(); }
  // Moves the points to the next picture; `motion`: motionBetween(before, now). Drops points that left it or look
  // different.
  void follow(const GrayPicture& before, const GrayPicture& now, const std::vector<Motion>& motion);
  // Adds new points, of age 0, where there are none.
  void seed(const GrayPicture& now);

  [[nodiscard]] std::vector<TrackedPoint>& points() noexcept { return points_; }
  [[nodiscard]] const std::vector<TrackedPoint>& points() const noexcept { return points_; }

 private:
  std::vector<TrackedPoint> points_;
};

}  // namespace relievo
