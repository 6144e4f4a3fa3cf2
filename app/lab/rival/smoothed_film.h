// SPDX-License-Identifier: Apache-2.0
// Films whose depth is smoothed frame by frame, and methods that run on them.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "app/depth_window/surface_window.h"
#include "app/depth_window/touch_plan.h"
#include "app/haptics/method/method.h"
#include "app/lab/film/film_run.h"
#include "app/lab/rival/depth_smoother.h"

namespace relievo {

// The width w of the Gaussian that leaves the least expected error in the force, of the same measures as TouchPlan's.
// Three errors are weighed: white noise leaves noise x sample / (sqrt(4 pi) w^2) in the slope; the codes' steps leave
// half of step / (7.09 w), and twice as much after a codec, with which H.264's worst scene is best (crf 23); and a bump
// of 8 mm curvature radius loses 1.2 % of its force x (w/1 mm)^2 (measured, 16 bits).
[[nodiscard]] double blurWidthMm(const ClipMeasure& clip);

// The film with every frame blurred by a Gaussian of this standard deviation (DepthSmoother), in 16 bits. A frame that
// repeats the previous one is not blurred again. Uses all processors.
[[nodiscard]] MemoryFilm smoothedFilm(const MemoryFilm& film, double sigma_mm,
                                      DepthSmoother::Order order = DepthSmoother::Order::First);

// A method that runs on the smoothed frames in place of those in its window. The frames of `film` are smoothed here;
// `film` must contain every frame that the windows will show, in any order.
[[nodiscard]] std::unique_ptr<TouchMethod> onSmoothedDepth(std::unique_ptr<TouchMethod> method,
                                                           std::span<const TimedSurface> film, double sigma_mm);

// How long the blur of one frame takes on one processor.
class FrameStopwatch {
 public:
  FrameStopwatch(const MemoryFilm& film, double sigma_mm);
  // Blurs the film's next frame, starting over after the last one.
  void timeOne();
  // The shortest time: other work on the machine can only add to it.
  [[nodiscard]] double leastMs() const { return least_ms_; }

 private:
  std::span<const TimedSurface> frames_;
  DepthSmoother smoother_;
  std::vector<std::uint16_t> codes_;
  std::size_t count_ = 0;
  double least_ms_ = std::numeric_limits<double>::infinity();
};

}  // namespace relievo
