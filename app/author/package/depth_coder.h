// SPDX-License-Identifier: Apache-2.0
// Converts any depth frame to codes of one form (full range, near high) and reports what was changed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/author/package/depth_coding.h"
#include "app/author/package/picture.h"
#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// The normalised code s (see DepthCalibration), near high, becomes round((2^bits - 1) s): codes of the same bits, full
// range and near high are unchanged. If the law is to change, s is first replaced by that of the same height under the
// new law. If the source may have holes, code 0 is reserved for them (`invalid` of the outcome) and every other code is
// at least 1. A lossy codec moves codes by a few: then the 32nd part of the codes at the lower end are holes, and depth
// begins as far above them (`codes` of the outcome).
class DepthCoder {
 public:
  explicit DepthCoder(const DepthCalibration& source, const DepthCoding& coding = {});

  // The calibration of the output codes, to be stored with them.
  [[nodiscard]] const DepthCalibration& outcome() const noexcept { return outcome_; }

  // Unsupported if the frame lacks the component that the calibration names.
  [[nodiscard]] Result<void> encode(const Frame& depth, DepthPicture& picture);

  // One line per change made to the codes; empty if they are unchanged.
  [[nodiscard]] std::vector<std::string> explain() const;

  struct Counts {
    int bits = 8;
    std::vector<std::uint64_t> of_code = std::vector<std::uint64_t>(256);  // size 2^bits; holes are not counted here
    std::uint64_t holes = 0;
    std::uint64_t clipped = 0;  // codes outside the range that the calibration gives
    std::uint64_t samples = 0;
  };
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  [[nodiscard]] std::uint16_t codeOf(double s) const noexcept;

  DepthCalibration source_;
  DepthCalibration outcome_;
  std::vector<std::uint16_t> from_luma_;  // by source code
  std::vector<std::uint8_t> is_clipped_;  // by source code
  Counts counts_;
};

}  // namespace relievo
