// SPDX-License-Identifier: Apache-2.0
// Makes a container's timestamps continuous where they jump: when a counter wraps or an encoder restarts.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "hal/media/media_time.h"

namespace relievo {

// A timestamp is accepted while it increases within its stream and is at most `longest_gap` past the latest of all
// streams: a smaller gap is lost data, which the film waits out. Any other timestamp is a jump: it is moved to one step
// (the stream's last) after the stream's last time. All streams get the same offset, so that they stay in sync.
//
// The first timestamp of a stream may lie three times `longest_gap` behind: a part of an HLS film has all its pictures
// before its sound, and may last over 10 s.
//
// Streams are interleaved, so one reaches the jump before another. Until all have passed it, each packet gets the
// offset, old or new, that continues its stream best. Pure arithmetic; one thread.
class ContinuousTime {
 public:
  // Resets: the next packet is the first. `longest_gap` 0: every timestamp is accepted.
  void begin(Duration longest_gap) noexcept;
  // The offset to add to the timestamps of the next packet of `stream`, whose decoding time is `time`.
  [[nodiscard]] Duration offsetFor(int stream, MediaTime time);
  // Since construction.
  [[nodiscard]] std::uint64_t jumps() const noexcept { return jumps_; }

 private:
  struct Line {
    MediaTime last;
    Duration step{0};
  };
  [[nodiscard]] bool goesOn(const Line* line, MediaTime time) const noexcept;

  Duration longest_gap_{0};
  Duration offset_{0};
  std::optional<Duration> before_;  // the offset before the last jump, while packets from before it may come
  MediaTime jumped_at_;
  std::optional<MediaTime> latest_;  // of all streams
  std::map<int, Line> lines_;
  std::uint64_t jumps_ = 0;
};

}  // namespace relievo
