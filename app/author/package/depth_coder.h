// SPDX-License-Identifier: Apache-2.0
// Any depth frame as codes of one meaning: full range, near is high; and what was done to get there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/author/package/depth_coding.h"
#include "app/author/package/picture.h"
#include "app/scene/depth_calibration.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// The normalised code s (see DepthCalibration), near high, becomes round((2^bits - 1) s): codes of as many bits, full
// range and near high go through unchanged. Where the law is to be another one, s is first that of the same height in
// it. Where the source may have holes, code 0 is theirs alone (`invalid` of the outcome) and every other code is 1 at
// least.
class DepthCoder {
 public:
  explicit DepthCoder(const DepthCalibration& source, const DepthCoding& coding = {});

  // What the codes mean; to be written beside them.
  [[nodiscard]] const DepthCalibration& outcome() const noexcept { return outcome_; }

  // Unsupported for a frame that has not what the calibration speaks of.
  [[nodiscard]] Result<void> encode(const Frame& depth, DepthPicture& picture);

  // One line for each thing that was done to the codes; empty when they went through unchanged.
  [[nodiscard]] std::vector<std::string> explain() const;

  struct Counts {
    int bits = 8;
    std::vector<std::uint64_t> of_code = std::vector<std::uint64_t>(256);  // 2^bits; holes are not counted here
    std::uint64_t holes = 0;
    std::uint64_t clipped = 0;  // codes beyond those that the calibration names
    std::uint64_t samples = 0;
  };
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  [[nodiscard]] std::uint16_t codeOf(double s) const noexcept;

  DepthCalibration source_;
  DepthCalibration outcome_;
  std::vector<std::uint16_t> from_luma_;  // by the source's code
  std::vector<std::uint8_t> is_clipped_;  // likewise
  Counts counts_;
};

}  // namespace relievo
