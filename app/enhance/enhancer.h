// SPDX-License-Identifier: Apache-2.0
// Depth enhancement: removes a sensor's holes and noise from a depth film.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "app/enhance/cleaning.h"
#include "app/enhance/depth_map.h"

namespace relievo {

enum class Enhancement : std::uint8_t {
  Median,     // holes filled, then the median of 5 x 5 samples
  Dibm,       // depth-image-based modelling: after the median, each picture as a smoothed mesh of feature points
  SpaceTime,  // after the median, means over five pictures and line fits over a few samples; neither crosses a step
};
// "median", "dibm", "space-time".
[[nodiscard]] const char* name(Enhancement how) noexcept;

struct EnhancementSummary {
  std::uint64_t pictures = 0, samples = 0;
  std::uint64_t holes = 0, outliers = 0, filled = 0;  // samples
  double noise_before = 0, noise_after = 0;           // levels of 255: mean noise from sample to sample
  double points = 0;                                  // mean number of mesh points; 0 without a mesh
  std::size_t most_points = 0;
  double bound = 0;  // levels of 255: mean of the mesh's error bound
  // Levels of 255: mean estimated height error before and after, away from edges.
  double error_before = 0, error_after = 0;
};

// Use from one thread; OpenCV's threads share the work on a picture, and their number changes nothing in the result. A
// picture comes out at once, or with `space-time` after two more have gone in, so that memory use is constant. Holes
// are filled first; wide ones stay (see cleaning.h).
//
// The error is estimated without knowing the true depth, from two parts assumed independent: the noise left from sample
// to sample, and the change of the means over blocks of samples. The second is at least an eighth of the original
// noise, since the block mean itself carries that much and it cannot be told from shape. The error before enhancement
// is the larger of the noise and the rounding of the source's codes.
class DepthEnhancer {
 public:
  // Largest distance of a sample from the mesh of `dibm`, before smoothing. Added to it is the uncertainty of the
  // codes: half a step of the source's, or four times the remaining noise if that is more.
  static constexpr double kBoundLevels = 0.25;

  DepthEnhancer(Enhancement how, const DepthCalibration& source);

  // The calibration of the output: 16 bits, since smoothing produces codes between those of the source.
  [[nodiscard]] const DepthCalibration& outcome() const noexcept { return outcome_; }

  // Adds the next picture; not after `finish`. Unsupported if the frame lacks the component that the calibration names,
  // or differs in size from the one before.
  [[nodiscard]] Result<void> add(const Frame& depth);
  void finish();
  // The enhanced pictures in order, with their timestamps. Nullopt if the next is not ready, or there is none.
  [[nodiscard]] std::optional<Frame> next();
  [[nodiscard]] EnhancementSummary summary() const;

 private:
  struct Picture {
    Frame source;
    DepthMap map;  // cleaned
    float noise = 0;
    CleaningCounts counts;
    std::vector<float> means;  // see shape_change.h
    float noise_after = 0;
    float error = 0;
    std::size_t samples = 0;
    std::size_t points = 0;
    float bound = 0;
    Frame outcome;
  };

  [[nodiscard]] std::size_t neighbours() const noexcept;
  void enhanceUntil(std::size_t end);
  [[nodiscard]] bool clean(Picture& picture);
  void enhance(std::size_t index);
  [[nodiscard]] DepthMap steadied(std::size_t index);
  [[nodiscard]] float grain(const Picture& picture) const;
  void model(Picture& picture, DepthMap& map) const;
  void count(const Picture& picture);

  Enhancement how_;
  DepthCalibration source_, outcome_;
  float code_step_;
  int width_ = 0, height_ = 0;
  std::deque<Picture> pictures_;  // finished ones still needed as neighbours, then cleaned ones
  std::size_t done_ = 0;
  std::deque<Frame> ready_;
  EnhancementSummary sums_;
};

}  // namespace relievo
