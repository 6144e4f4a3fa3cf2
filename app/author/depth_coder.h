// SPDX-License-Identifier: Apache-2.0
// Any depth frame as 8-bit codes of one meaning: full range, near is high; and what was done to get there.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "app/author/picture.h"
#include "app/scene/depth_calibration.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// The normalised code s (see DepthCalibration), near high, becomes round(255 s). Whole-number arithmetic for luma:
// 8-bit codes of full range and near high go through unchanged, those with near low are 255 - code. The law stays what
// it is. Where the source may have holes, code 0 is theirs alone (`invalid` of the outcome) and every other code is 1
// at least.
class DepthCoder {
 public:
  explicit DepthCoder(const DepthCalibration& source);

  // What the codes mean; to be written beside them.
  [[nodiscard]] const DepthCalibration& outcome() const noexcept { return outcome_; }

  // Unsupported for a frame that has not what the calibration speaks of.
  [[nodiscard]] Result<void> encode(const Frame& depth, DepthPicture& picture);

  // One line for each thing that was done to the codes; empty when they went through unchanged.
  [[nodiscard]] std::vector<std::string> explain() const;

  struct Counts {
    std::array<std::uint64_t, 256> of_code{};  // holes are not counted here
    std::uint64_t holes = 0;
    std::uint64_t samples = 0;
  };
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  DepthCalibration source_;
  DepthCalibration outcome_;
  std::vector<std::uint8_t> from_luma_;  // by the source's code
  Counts counts_;
};

}  // namespace relievo
