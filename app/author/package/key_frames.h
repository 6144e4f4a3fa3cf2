// SPDX-License-Identifier: Apache-2.0
// Where key frames go: about every second, at cuts, and at the same places in both tracks, so that a seek lands in both
// at once.
#pragma once

#include <optional>

#include "hal/media_time.h"

namespace relievo {

class KeyFrames {
 public:
  static constexpr Duration kEvery = std::chrono::seconds(1);
  static constexpr Duration kLatest = std::chrono::seconds(2);

  // For each picture of the colour in turn: whether it is a key frame. `depth_is_new` says that a depth picture is
  // written with it; a held one cannot become a key frame any more, so the next one is waited for, but not for ever.
  // `cut`: it begins a shot, and so does that depth picture.
  [[nodiscard]] bool isDue(MediaTime color, bool depth_is_new, bool cut = false) noexcept {
    const bool first = !last_;
    const Duration since = first ? Duration(0) : color - *last_;
    // Times are rounded by containers: a second less half a millisecond is a second.
    const bool due = first || (cut && depth_is_new) || since > kLatest ||
                     (depth_is_new && since > kEvery - std::chrono::microseconds(1500));
    if (due) last_ = color;
    return due;
  }

 private:
  std::optional<MediaTime> last_;
};

}  // namespace relievo
