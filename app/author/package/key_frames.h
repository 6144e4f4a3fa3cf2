// SPDX-License-Identifier: Apache-2.0
// Places key frames about every second and at cuts, at the same times in both tracks, so that a seek works in both.
#pragma once

#include <optional>

#include "hal/media/media_time.h"

namespace relievo {

class KeyFrames {
 public:
  static constexpr Duration kEvery = std::chrono::seconds(1);
  static constexpr Duration kLatest = std::chrono::seconds(2);

  // Call for each colour picture in turn; returns whether it is a key frame. `depth_is_new` says that a depth picture
  // is written with it: a held depth picture was written earlier and cannot become a key frame, so this waits for the
  // next one, within limits. `cut`: the picture begins a shot, and so does its depth picture.
  [[nodiscard]] bool isDue(MediaTime color, bool depth_is_new, bool cut = false) noexcept {
    const bool first = !last_;
    const Duration since = first ? Duration(0) : color - *last_;
    // Containers round timestamps, so half a millisecond under a second counts as a second.
    const bool due = first || (cut && depth_is_new) || since > kLatest ||
                     (depth_is_new && since > kEvery - std::chrono::microseconds(1500));
    if (due) last_ = color;
    return due;
  }

 private:
  std::optional<MediaTime> last_;
};

}  // namespace relievo
