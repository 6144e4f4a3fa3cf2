// SPDX-License-Identifier: Apache-2.0
// Guesses the calibration of a depth track from its first picture if nothing else defines it, and reports what looks
// wrong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "hal/frame.h"

namespace relievo {

// Histogram of a picture's gray codes.
class CodeCount {
 public:
  // Counts all samples of a gray or YUV picture, or of an RGB picture whose three components are equal.
  explicit CodeCount(const Frame& depth);

  [[nodiscard]] int bits() const noexcept { return bits_; }
  [[nodiscard]] std::uint64_t samples() const noexcept { return samples_; }
  [[nodiscard]] std::uint64_t of(std::uint32_t code) const { return of_code_[code]; }
  // The share of all samples with a code in `low` .. `high`, both included.
  [[nodiscard]] double share(std::uint32_t low, std::uint32_t high) const;
  // The quantile `q` of the codes in `low` .. `high`; `low` if there are none.
  [[nodiscard]] std::uint32_t quantile(double q, std::uint32_t low, std::uint32_t high) const;
  // The greatest common divisor of the codes that occur; 0 if only code 0 occurs.
  [[nodiscard]] std::uint32_t step() const;

 private:
  int bits_ = 8;
  std::uint64_t samples_ = 0;
  std::vector<std::uint64_t> of_code_;
};

struct DepthReading {
  CalibrationSettings settings;  // a calibration layer below everything that was stated
  std::string why;               // one line; empty if the picture revealed nothing
};

// 16-bit codes that leave out a large part of their range are not brightness but measurements: distances, or a Kinect's
// raw disparities. YUV that states no range has the full one if it uses codes outside the limited one. `said` holds the
// settings of command line, side file and tags; if they define what a code is, the picture is not consulted.
[[nodiscard]] DepthReading readCodes(const Frame& depth, const CodeCount& count, const CalibrationLayers& said);

// Reasons why the calibration is unlikely to be right: one line each, with the share of samples and the option to try.
[[nodiscard]] std::vector<std::string> doubtsOf(const Frame& depth, const DepthCalibration& calibration);

}  // namespace relievo
