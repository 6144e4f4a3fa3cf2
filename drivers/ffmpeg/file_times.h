// SPDX-License-Identifier: Apache-2.0
// Times of a file that was cut together without care, or was cut off.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "hal/media/continuous_time.h"
#include "hal/media/media_source.h"

struct AVFormatContext;

namespace relievo::ffmpeg {

// In an intact file decoding times never decrease. Where they do, later times are shifted so that the film continues
// from where it was. Pictures without a decoding time may be out of order, so they are shifted but not compared.
class FileTimes {
 public:
  // Call at the beginning, and after a seek.
  void begin() noexcept;
  // `url` names the film in the log.
  void mend(Packet& packet, const std::string& url);

 private:
  std::map<int, MediaTime> highest_;  // decoding time of each stream since its last jump
  ContinuousTime continuous_;
  Duration mended_by_{0};  // since `begin`
};

// What is missing within a DASH film: FFmpeg passes over a segment that it cannot open.
class FileGaps {
 public:
  // At the beginning, or after a seek.
  void begin() noexcept { ends_.clear(); }
  // Logs a gap before the packet; of many gaps, only the tenth, hundredth, .. `url` names the film in the log.
  void note(const Packet& packet, Duration length, const std::string& url);

 private:
  std::map<int, MediaTime> ends_;  // of each stream's last packet, by decoding time
  unsigned gaps_ = 0;
};

// How much of a film is missing behind what could be read.
class FileEnd {
 public:
  // As the file was opened; `start` is the container's (startOf).
  void open(const AVFormatContext& context, Duration start) noexcept;
  // Call for a seek: what it skips is not missing.
  void seek(MediaTime target) noexcept;
  // `position` of the packet in the file, in bytes; below 0 if unknown.
  void note(const Packet& packet, Duration length, std::int64_t position) noexcept;
  // Call after the last packet, with the container that was passed to `open`, if it has times.
  void reach(const AVFormatContext& context) noexcept;
  // 0 until the end was reached, for a whole film, and if unknown.
  [[nodiscard]] Duration missing() const noexcept { return missing_; }

 private:
  [[nodiscard]] Duration unread(const AVFormatContext& context) const noexcept;

  Duration start_{0};
  Duration latest_{0};  // end of all packets read so far, from `start_` on
  Duration missing_{0};
  std::int64_t bytes_ = 0;  // 0: unknown
  std::int64_t read_ = 0;   // to here, in bytes
};

}  // namespace relievo::ffmpeg
