// SPDX-License-Identifier: Apache-2.0
// The rate of a video track: exact, or variable with its range.
#pragma once

#include <string>
#include <vector>

#include "hal/media/media_source.h"

namespace relievo {

// From timestamps; 0 if unknown.
struct FrameRate {
  double average = 0;              // pictures per second
  Ratio exact;                     // the same, if the container states it and the timestamps agree
  double lowest = 0, highest = 0;  // over single steps, if they vary by more than a container rounds
  bool still = false;              // a single picture

  [[nodiscard]] bool varies() const noexcept { return highest > 0; }
};

// `times`: of the first pictures, in any order; `whole`: of all of them. The rate that the container states is used
// unless the timestamps show another.
[[nodiscard]] FrameRate frameRateOf(const StreamInfo& stream, std::vector<MediaTime> times, bool whole);

// "29.97 frames a second", "30.6 frames a second on average, variable from 15 to 120", "one picture".
[[nodiscard]] std::string rateText(const FrameRate& rate);

// The usual step between two pictures. `between`: the first two timestamps, which containers round; 0 for a single
// picture.
[[nodiscard]] Duration framePeriod(Duration between, const StreamInfo& stream) noexcept;

}  // namespace relievo
