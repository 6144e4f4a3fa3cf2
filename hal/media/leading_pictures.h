// SPDX-License-Identifier: Apache-2.0
// For decoders that give no picture for some packets: tells which of these are no damage.
#pragma once

#include <optional>

#include "hal/media/media_time.h"

namespace relievo {

// Pictures that are shown before the first key frame may refer to pictures before it, as after a seek in open groups: a
// decoder leaves them out without damage. Their packets come after the key frame's and before those of all pictures
// that are shown after it.
class LeadingPictures {
 public:
  // `pts`: of the first packet after `open` or a flush, a key frame's.
  void begin(MediaTime pts) noexcept { key_ = pts; }
  // Whether the picture of the next packet, in order of decoding, leads.
  [[nodiscard]] bool has(MediaTime pts) noexcept {
    if (key_ && pts > *key_) key_.reset();
    return key_ && pts < *key_;
  }

 private:
  std::optional<MediaTime> key_;  // until a picture after it has come
};

}  // namespace relievo
