// SPDX-License-Identifier: Apache-2.0
// Reads depth that is coded in colours: the position of each sample on the code's curve.
#pragma once

#include <limits>
#include <span>

#include "app/scene/color_curve.h"
#include "app/scene/color_samples.h"
#include "app/scene/sampled_block.h"
#include "hal/media/frame.h"
#include "platform/realtime.h"

namespace relievo {

// Trivially copyable. Does not own the samples. A position is 0 to 1 along the ColorCurve, or NaN at a hole.
//
// It is the point of the curve that is nearest to the sample's colour. Subsampled chroma mixes the two sides of a depth
// edge to a colour off the curve. Such a sample belongs to one of the surfaces nearby: a small change of that surface's
// height explains its brightness, which is not subsampled; a mixture with the other side explains its chroma; and
// chroma interpolated to its place holds the larger part of it. Where the edge is soft, and a point of the curve
// between the two sides explains the colour better, that point is used. If the nearby sample that is most like it
// in brightness is black or red, it is a hole. If no nearby sample is on the curve, the sample's own reading is used if
// its colour is not far off. Red, where both ends of the depth meet on the circle of hues, is a hole in YUV unless a
// surface beside it ends there.
class ColorReading {
 public:
  ColorReading() = default;  // reads nothing
  // `frame` is YUV or RGB, and `code` is not luma. Makes the code's curve if it is the first: not for a real-time
  // thread.
  ColorReading(const Frame& frame, DepthCode code);

  [[nodiscard]] double shareAt(int c, int r) const RELIEVO_RT {
    const YuvColor own = samples_.at(c, r);
    const ColorCurve::Point reading = curve_->nearest(own);
    return reading.distance <= kUnmixed && isSure(reading) ? static_cast<double>(reading.s)
                                                           : shareBeside(c, r, own, reading);
  }
  // The same of four samples of a row, which are computed side by side where they are on the curve.
  void sharesOfFour(const int* columns, int r, double* shares) const RELIEVO_RT;
  // Colours that differ little lie on one straight piece of the curve, or nearly so: their mean is the colour of the
  // mean height. A hole if they differ more, or stand for no depth.
  [[nodiscard]] double shareOfBlock(int c0, int r0, const SampledBlock& block) const RELIEVO_RT;

  // What one code of the samples changes in the position, on average over the curve.
  [[nodiscard]] double step() const noexcept { return curve_->meanPerColor() * samples_.step(); }

  // Whether chroma is equal in every sample; brightness is not compared. The other picture has this one's format.
  [[nodiscard]] bool sameChroma(const ColorReading& other) const noexcept {
    return samples_.sameChroma(other.samples_, cols_, rows_);
  }
  // Whether the other picture has the same format and code, wherever it lies.
  [[nodiscard]] bool readsLike(const ColorReading& other) const noexcept {
    return curve_ == other.curve_ && cols_ == other.cols_ && rows_ == other.rows_ && samples_.readsLike(other.samples_);
  }
  bool operator==(const ColorReading&) const = default;

 private:
  static constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] bool isSure(const ColorCurve::Point& point) const RELIEVO_RT {
    if (point.distance > kOnCurve) return false;
    return !curve_->closed() || (point.s > kSeam && point.s < 1 - kSeam);
  }
  [[nodiscard]] double shareBeside(int c, int r, const YuvColor& own,
                                   const ColorCurve::Point& reading) const RELIEVO_RT;
  // `sides`: the readings nearby, from `low` to `high`.
  [[nodiscard]] float shareAtEdge(int c, int r, const YuvColor& own, std::span<const float> sides, float low,
                                  float high) const RELIEVO_RT;

  // Distance of a colour from the curve, in ColorCurve's coordinates. Measured on H.264 4:2:0 at crf 18 to 23: nine of
  // ten samples are nearer than 0.01, mixed ones farther than 0.05.
  static constexpr float kOnCurve = 0.06F;
  // A sample that is farther is compared with those nearby: two hues that are close mix to a colour near the curve.
  static constexpr float kUnmixed = 0.02F;
  // Half the width of the circle's seam: coding moves a hue by 0.0044 in one sample of twenty.
  static constexpr float kSeam = 0.006F;

  ColorSamples samples_;
  const ColorCurve* curve_ = nullptr;
  int cols_ = 0, rows_ = 0;
};

}  // namespace relievo
