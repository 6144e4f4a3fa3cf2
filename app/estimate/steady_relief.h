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

// In each shot, the first picture with any relief sets the scale: its nearest and farthest twentieth are placed at 85
// and 15 % of the relief's depth, and what lies beyond is compressed into the rest. Points of it are tracked. Each
// further estimate is scaled and shifted to the mean heights that these points have had since they appeared, as most of
// them agree, so the error of one picture does not persist. New points take their heights from the steady relief.
// Remaining flicker is averaged along the picture's motion, except where height or colour has changed. A cut, or a
// picture without anything of the last one, begins anew.
//
// Use from one thread; OpenCV's threads help.
class SteadyRelief {
 public:
  // 16 bits of full range, near high, heights linear in the estimate: in relative inverse depth.
  [[nodiscard]] static DepthCalibration calibration();

  // Adds the next picture and its estimate; all pictures have one size. Returns a frame at time 0.
  [[nodiscard]] Frame add(const RawPicture& picture, const DepthEstimate& estimate);

  [[nodiscard]] std::size_t shots() const noexcept { return shots_; }
  // The largest variation of the estimates' scale within a shot: .2 is 20 %.
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
  bool anchored_ = false;  // a picture of the shot has set the scale
  std::size_t shots_ = 0;
  double least_scale_ = 0, most_scale_ = 0;  // of the shot
  double wandered_ = 0;
};

}  // namespace relievo
