// SPDX-License-Identifier: Apache-2.0
// Films whose depth was smoothed frame by frame, for methods that feel it so.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "app/depth_window/surface_window.h"
#include "app/haptics/method/method.h"
#include "app/lab/film/film_run.h"
#include "app/lab/rival/depth_smoother.h"

namespace relievo {

// The film, every frame blurred by a Gaussian of this standard deviation (DepthSmoother), in 16 bits. A frame that
// repeats the one before it is not blurred again. On all processors.
[[nodiscard]] MemoryFilm smoothedFilm(const MemoryFilm& film, double sigma_mm);

// A method that is given the frames of a film as they were smoothed when the film was opened, whenever and in whatever
// order a feed hands them on. `film` has all the frames that it will be shown.
[[nodiscard]] std::unique_ptr<TouchMethod> onSmoothedDepth(std::unique_ptr<TouchMethod> method,
                                                           std::span<const TimedSurface> film, double sigma_mm);

// How long the blur of one frame takes on one processor.
class FrameStopwatch {
 public:
  FrameStopwatch(const MemoryFilm& film, double sigma_mm);
  // Blurs the film's next frame; after the last one the first.
  void timeOne();
  // Of the quickest: what else the machine does can only add to it.
  [[nodiscard]] double leastMs() const { return least_ms_; }

 private:
  std::span<const TimedSurface> frames_;
  DepthSmoother smoother_;
  std::vector<std::uint16_t> codes_;
  std::size_t count_ = 0;
  double least_ms_ = std::numeric_limits<double>::infinity();
};

}  // namespace relievo
