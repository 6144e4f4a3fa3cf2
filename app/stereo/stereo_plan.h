// SPDX-License-Identifier: Apache-2.0
// The results of surveying a film of two views, shot by shot.
#pragma once

#include <string>
#include <vector>

#include "app/stereo/alignment.h"
#include "app/stereo/disparity_map.h"
#include "app/stereo/exposure.h"
#include "hal/media/media_time.h"

namespace relievo {

// The whole of a shot is corrected and scaled alike, so that nothing seems to move in depth.
struct ShotPlan {
  MediaTime begin;
  Alignment alignment;
  bool is_aligned = false;  // the right view has to be aligned
  Exposure exposure;
  bool is_balanced = false;  // the right view has to be matched to the left one's exposure
  DisparityRange range;
  bool has_depth = false;  // false: the shot is flat: a view is black, both are one picture or have nothing in common
};

struct StereoPlan {
  int cols = 0, rows = 0;  // of a view
  std::vector<ShotPlan> shots;
  bool views_swapped = false;      // the first view is the right eye's
  bool order_known = false;        // false: the pictures do not show which eye's view is first
  std::vector<std::string> notes;  // what was corrected; one line each

  // The shot at a time; the first one before it begins.
  [[nodiscard]] const ShotPlan& at(MediaTime time) const;
};

}  // namespace relievo
