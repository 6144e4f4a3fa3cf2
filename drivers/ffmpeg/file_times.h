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

// The lengths of packets. Where a container states none (WMV), a packet is as long as the step to it.
class PacketLengths {
 public:
  // At the beginning, or after a seek.
  void begin() noexcept { lines_.clear(); }
  // 0 if unknown.
  [[nodiscard]] Duration of(const Packet& packet, Duration stated);

 private:
  struct Line {
    MediaTime last;
    Duration step{0};
  };
  std::map<int, Line> lines_;
};

enum class Doubt : std::uint8_t {
  None,
  Steady,   // no sign of a loss, but the stream's rate does not explain a gap either
  Damaged,  // FFmpeg has passed over bytes or parts
};

// What is missing within a film: FFmpeg passes over what it cannot read, such as a segment of a list.
class FileGaps {
 public:
  // At the beginning, or after a seek.
  void begin() noexcept;
  // A gap counts as missing if a packet near it is in doubt, or if it is a stream's first one since `losses` has grown:
  // elsewhere a picture may just last longer. It is logged, unless a loss explains it, which was; of many gaps, only
  // the tenth, hundredth, .. `url` names the film in the log. A long gap in a steady stream is logged as well.
  // `losses`: of whole parts, since `begin` or since the film was opened.
  void note(const Packet& packet, Duration length, Doubt doubt, unsigned losses, const std::string& url);
  // Of the stream that lacks most.
  [[nodiscard]] Duration missing() const noexcept;

 private:
  struct End {
    MediaTime time;
    MediaTime doubtful_until;  // by a packet before, of any stream
    unsigned losses = 0;       // that have left their gap
  };
  std::map<int, End> ends_;  // of each stream's last packet, by decoding time
  std::map<int, Duration> missing_;
  unsigned gaps_ = 0;
};

// How much of a film is missing behind what could be read.
class FileEnd {
 public:
  struct Reached {
    Duration latest{0};      // end of all packets read so far, from the start on
    Duration picture{0};     // the last packet's length
    std::int64_t last = 0;   // where the last packet begins, in bytes
    std::int64_t read = 0;   // to here
    std::int64_t bytes = 0;  // of the file as it was opened; 0: unknown
  };

  // As the file was opened; `start` is the container's (startOf).
  void open(const AVFormatContext& context, Duration start) noexcept;
  // Call for a seek: what it skips is not missing.
  void seek(MediaTime target) noexcept;
  // `broken`: FFmpeg has not found the whole packet. `position` in the file, in bytes; below 0 if unknown.
  void note(const Packet& packet, Duration length, bool broken, std::int64_t position) noexcept;
  // Call after the last packet, if the film has times, with the container that was passed to `open`, or that a seek has
  // opened of the same film. `doubtful`: FFmpeg warned there, and may have ended since it cannot read on.
  void reach(const AVFormatContext& context, bool doubtful) noexcept;
  // At least; 0 until the end was reached, for a whole film, and if unknown.
  [[nodiscard]] Duration missing() const noexcept { return missing_; }

 private:
  [[nodiscard]] Duration unread(const AVFormatContext& context, bool unreadable) const noexcept;

  Duration start_{0};
  Reached reached_;
  bool broken_ = false;  // the last packet
  bool sought_ = false;  // since it was opened, and not to the beginning
  Duration missing_{0};
};

}  // namespace relievo::ffmpeg
