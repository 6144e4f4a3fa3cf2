// SPDX-License-Identifier: Apache-2.0
// Depth pictures from the two views of a film while it plays.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "app/stereo/cut_finder.h"
#include "app/stereo/exposure.h"
#include "app/stereo/eye_order.h"
#include "app/stereo/quick/quick_matching.h"
#include "app/stereo/quick/small_view.h"
#include "app/stereo/quick/steady_disparity.h"
#include "app/stereo/quick/sub_pixel.h"
#include "hal/media/frame.h"

namespace relievo {

// One shot is scaled alike from its first picture to its last, so that nothing breathes: by the range that its first
// picture shows, with some to spare; what comes nearer or goes farther later lies at the end of the range, and is
// matched where it is, since a matcher that looks elsewhere finds another place in each picture. A right view that
// lies lower or higher, or is turned by up to two degrees, is straightened by what the shot's first picture shows.
// Views in the wrong order are told by what one eye alone sees, in the first picture or in several of the first two
// dozen, and matched in the right one from then on: as if a shot began there. Pictures come in order, not necessarily
// all of them. Use from one thread.
class QuickDepth {
 public:
  static constexpr int kCols = 640;                                   // of a depth picture, at most
  static constexpr std::array kMatchedCols{160, 240, 320, 480, 640};  // that are matched, the cheapest first

  // One of kMatchedCols, from the next shot on.
  void setMatchedCols(int cols) noexcept { wished_cols_ = cols; }
  [[nodiscard]] int matchedCols() const noexcept { return matched_cols_; }
  // The next picture does not continue the last one.
  void beginShot() noexcept { cuts_.forget(); }
  // Codes of 16 bits and full range, linear in disparity over the shot's range, near high, none a hole; with the left
  // view's time, in its shape. A shot without depth, as one with a black view, lies in the middle.
  [[nodiscard]] Frame depthOf(const Frame& left, const Frame& right);
  // Whether both views show the same things in the present shot, and not the same picture.
  [[nodiscard]] bool hasDepth() const noexcept { return range_.has_value(); }
  // True if both views of the present shot are the same picture, so that they give no depth.
  [[nodiscard]] bool isOnePicture() const noexcept { return one_picture_; }
  // Whether the right eye's view came first. The depth is that of the view that came first all the same.
  [[nodiscard]] bool areSwapped() const noexcept { return swapped_; }
  // Whether the present shot was asked for it, and neither it nor those before it told.
  [[nodiscard]] bool isOrderUnknown() const noexcept { return range_ && votes_left_ == 0 && !isOrderTold(); }
  // What the lowest and the highest code of the present shot mean: disparities as parts of the width, near is high.
  struct Range {
    float low = 0, high = 0;
  };
  [[nodiscard]] std::optional<Range> range() const noexcept { return range_; }

 private:
  [[nodiscard]] bool cutsTo(const ViewPicture& left);
  void level(const Frame& right, ViewSize size);
  void readStraight(const Frame& right, ViewSize size);
  void mirrorBoth();
  [[nodiscard]] std::optional<Range> reach();
  void measureShot();
  [[nodiscard]] bool isOrderTold() const noexcept { return eyes_.areInOrder() || eyes_.areSwapped(); }
  void orderEyes(int cols);
  void lookAgain();
  void match(DisparityMap& large);
  [[nodiscard]] DisparityRange rangeAt(int cols) const noexcept;
  [[nodiscard]] Frame codesOf(const DisparityMap& map) const;

  int wished_cols_ = kMatchedCols[2], matched_cols_ = kMatchedCols[2];
  CutFinder cuts_;
  std::optional<Range> range_;
  Range matched_;       // the same and what has come since
  int since_look_ = 0;  // pictures
  int votes_left_ = 0;  // of the shot, on the eyes
  int lower_ = 0;       // rows of the right view by which it lies too low
  double turned_ = 0;   // radians by which it is turned clockwise
  bool one_picture_ = false, swapped_ = false;
  EyeVotes eyes_;                     // of the shots' pictures, those of older shots less
  std::optional<Exposure> exposure_;  // that the right view needs
  ViewPicture left_, right_, small_left_, small_right_;
  QuickMatching matching_;
  DisparityMap filled_, large_;
  SubPixel sub_pixel_;
  SteadyDisparity steady_;
};

}  // namespace relievo
