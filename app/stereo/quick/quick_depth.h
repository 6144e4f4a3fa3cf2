// SPDX-License-Identifier: Apache-2.0
// Makes depth pictures from the two views of a film while it plays.
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

// The whole of a shot has one scale, so that nothing seems to move in depth: the range of its first picture, plus a
// margin. What comes nearer or goes farther later is placed at the range's end, but still matched at its true
// disparity, since a restricted matcher finds another wrong place in each picture. A right view that is shifted
// vertically, or turned by up to two degrees, is corrected by values from the shot's first picture. Swapped views are
// recognised by the points that only one eye sees, in the first picture or in several of the first two dozen, and
// exchanged from then on, as if a shot began there. Pictures come in order, not necessarily all of them. Use from one
// thread.
class QuickDepth {
 public:
  static constexpr int kCols = 640;                                   // of a depth picture, at most
  static constexpr std::array kMatchedCols{160, 240, 320, 480, 640};  // that are matched, the cheapest first

  // One of kMatchedCols, from the next shot on.
  void setMatchedCols(int cols) noexcept { wished_cols_ = cols; }
  [[nodiscard]] int matchedCols() const noexcept { return matched_cols_; }
  // Call if the next picture does not continue the last one.
  void beginShot() noexcept { cuts_.forget(); }
  // Codes of 16 bits and full range, linear in disparity over the shot's range, near high, without holes; with the left
  // view's time and shape. A shot without depth, such as one with a black view, has the middle code.
  [[nodiscard]] Frame depthOf(const Frame& left, const Frame& right);
  // True if both views of the present shot are the same picture, so that they give no depth.
  [[nodiscard]] bool isOnePicture() const noexcept { return one_picture_; }
  // True if the right eye's view came first. The depth is still that of the view that came first.
  [[nodiscard]] bool areSwapped() const noexcept { return swapped_; }
  // True if the present shot was examined, and neither it nor those before it showed the order.
  [[nodiscard]] bool isOrderUnknown() const noexcept { return range_ && votes_left_ == 0 && !isOrderTold(); }
  // The disparities of the present shot's lowest and highest code, as parts of the width; near is high. A shot without
  // depth has none.
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
  Range matched_;       // extended by what has come since
  int since_look_ = 0;  // pictures since the last check
  int votes_left_ = 0;  // pictures of the shot that may still vote on the eyes
  int lower_ = 0;       // rows by which the right view lies too low
  double turned_ = 0;   // radians by which it is turned clockwise
  bool one_picture_ = false, swapped_ = false;
  EyeVotes eyes_;                     // summed over the shots, older shots with less weight
  std::optional<Exposure> exposure_;  // that the right view needs
  ViewPicture left_, right_, small_left_, small_right_;
  QuickMatching matching_;
  DisparityMap filled_, large_;
  SubPixel sub_pixel_;
  SteadyDisparity steady_;
};

}  // namespace relievo
