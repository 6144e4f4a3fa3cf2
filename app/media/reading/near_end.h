// SPDX-License-Identifier: Apache-2.0
// Which end of a depth's codes is near, and what speaks against it.
#pragma once

#include <string>

#include "app/media/reading/depth_meaning.h"
#include "app/media/reading/depth_reading.h"
#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"
#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo {

// Chooses the calibration. Gray is near where it is bright, hues are near in the red. Either end of a colour map is as
// often near: it is the one that makes the view nearer below. So is the end of gray in a picture by itself, not in a
// film or a series of pictures, if the view speaks against the bright one; black that may be a hole is one then.
[[nodiscard]] Result<CalibrationChoice> chooseNearEnd(const DepthClues& clues, const Frame& look,
                                                      CalibrationLayers& layers, DepthReading& read);

// Whether the stream is one picture, or photos, each of which is shown for some seconds: of these as of one, a program
// or a camera wrote each by itself.
[[nodiscard]] bool isStill(const StreamInfo& stream);

struct NearEndDoubt {
  std::string line;    // empty: none
  bool usual = false;  // the view does not speak against the end that is taken
};

// A doubt where the near end is a guess. Where it is only likely, and no known kind, the offer becomes a doubt if the
// view is nearer above.
[[nodiscard]] NearEndDoubt doubtNearEnd(const CalibrationChoice& choice, bool is_known, const Frame& look,
                                        DepthReading& read);

}  // namespace relievo
