// SPDX-License-Identifier: Apache-2.0
// The relief of the next pictures, up to the next cut, for placing the subtitles.
#pragma once

#include <deque>

#include "app/depth_window/shots.h"
#include "app/depth_window/surface_window.h"
#include "app/player/film/depth_around.h"
#include "app/render/relief/coarse_relief.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"

namespace relievo {

// One thread. Each depth picture is read once, when it is first seen ahead.
class ComingRelief {
 public:
  // `present` is shown next, `coming` after it. True if `present` does not continue the picture before it.
  [[nodiscard]] bool follow(const Frame& present, const DepthComing& coming, const DepthCalibration& calibration,
                            const DisplayVolume& volume);
  // What comes after the present picture. It points into this object and is valid until the next `follow` or `forget`.
  [[nodiscard]] ReliefAhead ahead() const noexcept;
  // Call when the film continues elsewhere.
  void forget();

 private:
  struct Seen : TimedSurface {
    CoarseRelief coarse;
  };
  static constexpr std::size_t kBefore = 2;
  [[nodiscard]] bool add(const Frame& depth, const DepthCalibration& calibration, const DisplayVolume& volume);

  std::deque<Seen> seen_;     // at most kBefore before the present picture, then the coming ones
  std::size_t present_ = 0;   // index of the present picture in `seen_`
  std::deque<int> pictures_;  // for each coming picture, its distance from the present one in pictures
  bool more_ = true;
  ShotFinder shots_;
};

}  // namespace relievo
