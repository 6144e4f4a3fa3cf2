// SPDX-License-Identifier: Apache-2.0
// Surveys a film of two views: where shots begin, how the views are aligned, and the range of disparities.
#pragma once

#include <optional>
#include <vector>

#include "app/stereo/cut_finder.h"
#include "app/stereo/eye_order.h"
#include "app/stereo/quick/quick_matching.h"
#include "app/stereo/stereo_plan.h"
#include "app/stereo/view_picture.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// Use from one thread; OpenCV's threads help. Memory does not grow with the film's length, except with the number of
// shots.
class StereoSurvey {
 public:
  // Adds the next pictures, in order, each view of one size. Unsupported if a size changes.
  [[nodiscard]] Result<void> add(const Frame& left, const Frame& right);
  // Call after the last picture. Unsupported if there is no depth: one view is black, both are the same picture, or
  // they have nothing in common.
  [[nodiscard]] Result<StereoPlan> finish();

 private:
  struct Looked {
    ViewPicture left, right;  // at most kKeptCols wide
  };

  [[nodiscard]] bool beginsShot(const Frame& left);
  void look(const Frame& left, const Frame& right);
  void beginShot(MediaTime begin);
  void endShot();
  void measureRange(ShotPlan& shot);
  void askEyes(const ShotPlan& shot);
  void explain();

  StereoPlan plan_;
  CutFinder cuts_;
  MediaTime looked_at_;
  // For the present shot:
  std::vector<PointPair> pairs_;
  ViewTone left_tone_, right_tone_;
  std::vector<Looked> looked_;
  int stride_ = 1, until_next_ = 0;
  // For the whole film:
  EyeVotes eyes_;
  QuickMatching quick_;
  std::uint64_t pictures_ = 0, one_black_ = 0, alike_ = 0;
  int unfitting_ = 0;
  std::size_t same_ = 0;  // shots whose views are the same picture
};

}  // namespace relievo
