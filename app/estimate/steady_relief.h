// SPDX-License-Identifier: Apache-2.0
// Makes one steady relief of estimates that differ in scale and offset from picture to picture.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "app/estimate/depth_estimator.h"
#include "app/estimate/point_tracks.h"
#include "app/estimate/relief_fit.h"
#include "app/motion/motion_field.h"
#include "app/scene/depth_calibration.h"
#include "app/stereo/cut_finder.h"
#include "hal/media/frame.h"

namespace relievo {

// In each shot, the first picture that shows something decides: its nearest and farthest twentieth lie at 85 and 15 %
// of the relief's depth, and what is nearer or farther is squeezed into the rest. Points of it are followed. Each
// further estimate is scaled and shifted to the heights that these points have had on average since they came into the
// picture, as most of them agree; so an error of one picture leaves nothing behind. Points that come in later take
// their heights from the steady relief. What flickers beyond that is averaged along the motion of the picture, but for
// what has changed its height or its colour. A cut, or a picture that continues nothing, begins anew.
//
// Use from one thread; OpenCV's threads help.
class SteadyRelief {
 public:
  // 16 bits of full range, near high, heights linear in the estimate: in relative inverse depth.
  [[nodiscard]] static DepthCalibration calibration();

  // The next picture and its estimate; all of one size. A frame at time 0.
  [[nodiscard]] Frame add(const RawPicture& picture, const DepthEstimate& estimate);

  [[nodiscard]] std::size_t shots() const noexcept { return shots_; }
  // By how much the estimates' scale varied within a shot, at most: .2 is 20 %.
  [[nodiscard]] double wandered() const noexcept { return wandered_; }

 private:
  using Heights = std::vector<float>;  // row by row

  void begin(const DepthEstimate& estimate);
  [[nodiscard]] bool follow(const GrayPicture& gray, const DepthEstimate& estimate);
  void plant(const GrayPicture& gray);
  void smooth(Heights& heights, const GrayPicture& gray) const;

  CutFinder cuts_;
  PointTracks tracks_;
  std::optional<GrayPicture> before_;
  std::vector<Motion> motion_;  // from the present picture to the one before
  ReliefFit fit_;
  int cols_ = 0, rows_ = 0;
  Heights heights_;        // of the picture before
  bool anchored_ = false;  // the shot has shown something
  std::size_t shots_ = 0;
  double least_scale_ = 0, most_scale_ = 0;  // of the shot
  double wandered_ = 0;
};

}  // namespace relievo
