// SPDX-License-Identifier: Apache-2.0
// Times of a file that was cut together without care.
#pragma once

#include <map>
#include <string>

#include "hal/media/continuous_time.h"
#include "hal/media/media_source.h"

namespace relievo::ffmpeg {

// A file's decoding times never fall, whatever its gaps. Where they do, the film continues where it was. Pictures
// without a decoding time may be reordered and judge nothing.
class FileTimes {
 public:
  // At the beginning, or after a seek.
  void begin() noexcept;
  // `url` names the film in the log.
  void mend(Packet& packet, const std::string& url);

 private:
  std::map<int, MediaTime> highest_;  // decoding time of each stream since its last jump
  ContinuousTime continuous_;
  Duration mended_by_{0};  // since `begin`
};

}  // namespace relievo::ffmpeg
