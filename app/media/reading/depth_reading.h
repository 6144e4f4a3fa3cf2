// SPDX-License-Identifier: Apache-2.0
// What the codes of a depth track mean, read off its first picture where nobody has said it; and what looks wrong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "hal/frame.h"

namespace relievo {

// The gray codes of a picture, counted.
class CodeCount {
 public:
  // All samples of a gray or YUV picture, or of one in RGB whose three components are the same.
  explicit CodeCount(const Frame& depth);

  [[nodiscard]] int bits() const noexcept { return bits_; }
  [[nodiscard]] std::uint64_t samples() const noexcept { return samples_; }
  [[nodiscard]] std::uint64_t of(std::uint32_t code) const { return of_code_[code]; }
  // In codes from `low` to `high`, both included; share of all samples.
  [[nodiscard]] double share(std::uint32_t low, std::uint32_t high) const;
  // The code below which the share `q` of the samples with a code in `low` .. `high` lies; `low` when there are none.
  [[nodiscard]] std::uint32_t quantile(double q, std::uint32_t low, std::uint32_t high) const;
  // The greatest number that divides every code that occurs; 0 where only 0 occurs.
  [[nodiscard]] std::uint32_t step() const;

 private:
  int bits_ = 8;
  std::uint64_t samples_ = 0;
  std::vector<std::uint64_t> of_code_;
};

struct DepthReading {
  CalibrationSettings settings;  // the layer below all that was said
  std::string why;               // one line; empty where nothing was read off the picture
};

// 16-bit codes that leave out a large part of their range are no brightness but what a sensor has measured: distances,
// or the raw disparities of a Kinect. YUV that names no range is of the full one when it uses codes beyond the limited
// one. `said`: what command line, side file and tags have settled; a picture is not asked where they say what a code
// is.
[[nodiscard]] DepthReading readCodes(const Frame& depth, const CodeCount& count, const CalibrationLayers& said);

// What makes it unlikely that the calibration is the right one: one line each, with its share and with what to type.
[[nodiscard]] std::vector<std::string> doubtsOf(const Frame& depth, const DepthCalibration& calibration);

}  // namespace relievo
