// SPDX-License-Identifier: Apache-2.0
// Depth enhancement: a depth film without its sensor's holes and noise, as smooth as a finger should feel it.
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
  Median,     // holes filled, the median of five by five samples
  Dibm,       // depth-image-based modelling: behind the median, each picture as the smoothed mesh of its feature points
  SpaceTime,  // behind the median, means over five pictures and lines fitted over a few samples; neither across a step
};
// "median", "dibm", "space-time".
[[nodiscard]] const char* name(Enhancement how) noexcept;

struct EnhancementSummary {
  std::uint64_t pictures = 0, samples = 0;
  std::uint64_t holes = 0, outliers = 0, filled = 0;  // samples
  double noise_before = 0, noise_after = 0;           // levels of 255: what is new from sample to sample, in the mean
  double points = 0;                                  // of a mesh, in the mean; 0 without one
  std::size_t most_points = 0;
  double bound = 0;  // levels of 255, in the mean: how far from the mesh the samples are at most
  // Levels of 255, in the mean: estimates of how far the heights were off and are now, away from edges.
  double error_before = 0, error_after = 0;
};

// One thread; its work on several pictures at once goes to OpenCV's threads. A picture comes out after a few more have
// gone in, so that memory is flat. Holes are filled first; wide ones stay (see cleaning.h).
//
// The error is estimated without knowing the true depth, from two parts taken as independent: the noise that is left
// from sample to sample, and how far the means of blocks of samples were moved. The latter counts as an eighth of the
// noise before at least, as that much is in such a mean itself, and no picture tells it from shape. Before, it is the
// noise, or the rounding of the source's codes where that is more.
class DepthEnhancer {
 public:
  // How far a sample may be from the mesh of `dibm` before smoothing. What the codes cannot tell comes on top: half a
  // step of the source's, or four times the noise that is left if that is more.
  static constexpr double kBoundLevels = 0.25;

  DepthEnhancer(Enhancement how, const DepthCalibration& source, double bound_levels = kBoundLevels);

  // What the codes of the pictures that come out mean: 16 bits, as smoothing makes codes between those of the source.
  [[nodiscard]] const DepthCalibration& outcome() const noexcept { return outcome_; }

  // The next picture; none after `finish`. Unsupported for a frame that has not what the calibration speaks of, or of
  // another size than the one before.
  [[nodiscard]] Result<void> add(const Frame& depth);
  [[nodiscard]] Result<void> finish();
  // In the order in which they went in, with their times. Nothing: the next is not ready yet, or there is none.
  [[nodiscard]] std::optional<Frame> next();
  [[nodiscard]] EnhancementSummary summary() const;

 private:
  struct Picture {
    Frame source;
    DepthMap map;
    float noise = 0;
    CleaningCounts counts;
    std::vector<float> means;  // see shape_change.h
    float noise_after = 0;
    float error = 0;
    std::size_t points = 0;
    float bound = 0;
    Frame outcome;
  };

  [[nodiscard]] Result<void> work();
  [[nodiscard]] bool clean(Picture& picture) const;
  void enhance(std::size_t index);
  [[nodiscard]] DepthMap steadied(std::size_t index) const;
  [[nodiscard]] float grain(const Picture& picture) const;
  void model(Picture& picture, DepthMap& map) const;
  void count(const Picture& picture);

  Enhancement how_;
  DepthCalibration source_, outcome_;
  float bound_, code_step_;
  std::size_t at_once_;
  std::deque<Picture> pictures_;  // done ones that are looked back at, then cleaned ones, then those just gone in
  std::size_t done_ = 0, cleaned_ = 0;
  bool ended_ = false;
  std::deque<Frame> ready_;
  EnhancementSummary sums_;
};

}  // namespace relievo
