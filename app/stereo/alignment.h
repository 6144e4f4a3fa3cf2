// SPDX-License-Identifier: Apache-2.0
// Measures how the right view is misaligned with the left one, and corrects it.
#pragma once

#include <vector>

#include "app/stereo/view_picture.h"

namespace relievo {

// A point that was found in both views, in pixels from their centres, y down.
struct PointPair {
  double left_x = 0, left_y = 0, right_x = 0, right_y = 0;
};

// Corners and blobs (AKAZE) whose descriptors match only one point of the other view. Points that moved by more than a
// quarter of the width or a tenth of the height are left out.
[[nodiscard]] std::vector<PointPair> findPairs(const ViewPicture& left, const ViewPicture& right);

// y in the left view = shift + zoom * (y + turn * x) in the right one, for small turns, in pixels from the centres.
struct Alignment {
  double shift = 0;  // pixels: the right view lies too high
  double turn = 0;   // radians: the right view is turned anticlockwise
  double zoom = 1;   // the right view is smaller

  // The most that a pixel moves up or down.
  [[nodiscard]] double reach(int cols, int rows) const;
};

struct AlignmentFit {
  Alignment alignment;
  double rest = 0;  // pixels: median vertical distance of the points after it
  int points = 0;
};

// The alignment that most pairs agree on: robust against a third of wrong pairs. With fewer than kLeastPairs none is
// found: `points` is 0.
constexpr int kLeastPairs = 24;
[[nodiscard]] AlignmentFit fitAlignment(const std::vector<PointPair>& pairs);

// The right view as a camera at the left one's height, upright, would have taken it; the border is repeated.
[[nodiscard]] ViewPicture aligned(const ViewPicture& right, const Alignment& alignment);

}  // namespace relievo
