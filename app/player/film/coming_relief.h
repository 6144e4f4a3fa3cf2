// SPDX-License-Identifier: Apache-2.0
// What the subtitles will have behind them in the next pictures, as far as the next cut.
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
  // What comes after the present picture; it points into this object, until the next `follow` or `forget`.
  [[nodiscard]] ReliefAhead ahead() const noexcept;
  // The film goes on elsewhere.
  void forget();

 private:
  struct Seen : TimedSurface {
    CoarseRelief coarse;
  };
  static constexpr std::size_t kBefore = 2;
  [[nodiscard]] bool add(const Frame& depth, const DepthCalibration& calibration, const DisplayVolume& volume);

  std::deque<Seen> seen_;     // at most kBefore before the present one, and what comes
  std::size_t present_ = 0;   // its place in `seen_`
  std::deque<int> pictures_;  // how many pictures after the present one each of those that come is
  bool more_ = true;
  ShotFinder shots_;
};

}  // namespace relievo
