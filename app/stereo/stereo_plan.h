// SPDX-License-Identifier: Apache-2.0
// What a survey found out about a film of two views, shot by shot.
#pragma once

#include <string>
#include <vector>

#include "app/stereo/alignment.h"
#include "app/stereo/disparity_map.h"
#include "app/stereo/exposure.h"
#include "hal/media/media_time.h"

namespace relievo {

// One shot is corrected and scaled alike from its first picture to its last, so that nothing breathes.
struct ShotPlan {
  MediaTime begin;
  Alignment alignment;
  bool is_aligned = false;  // the right view has to be moved
  Exposure exposure;
  bool is_balanced = false;  // the right view has to be brought to the left one's tone
  DisparityRange range;
  bool has_depth = false;  // else the shot is flat: a view is black, or nothing was found in both
};

struct StereoPlan {
  int cols = 0, rows = 0;  // of a view
  std::vector<ShotPlan> shots;
  bool views_swapped = false;      // the first view is the right eye's
  bool order_known = false;        // else the pictures do not tell which eye's is first
  std::vector<std::string> notes;  // what was corrected; one line each

  // The shot at a time; the first one before it begins.
  [[nodiscard]] const ShotPlan& at(MediaTime time) const;
};

}  // namespace relievo
