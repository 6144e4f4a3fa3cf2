// SPDX-License-Identifier: Apache-2.0
// Makes one time line of a container's times that jump: a counter that wraps, an encoder that was started anew.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "hal/media_time.h"

namespace relievo {

// A time is believed while its stream goes on by it, and not further than `longest_gap` past all that came before: less
// is lost data, and the film waits it out. Any other time is a jump: it then follows the stream's last one by the
// stream's last step, and all streams are moved by as much, so that they keep their distance.
//
// Streams are interleaved, so that one comes to the jump before another: for so long each packet is put where it goes
// on best, on this side of the jump or on that. Plain numbers; one thread.
class ContinuousTime {
 public:
  // Forgets everything: the next packet is the first. `longest_gap` 0: every time is believed.
  void begin(Duration longest_gap) noexcept;
  // What has to be added to the times of the next packet of `stream`, which is decoded at `time`.
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
  std::optional<Duration> before_;  // the offset before the last jump, while packets of then may come
  MediaTime jumped_at_;
  std::optional<MediaTime> latest_;  // of all streams
  std::map<int, Line> lines_;
  std::uint64_t jumps_ = 0;
};

}  // namespace relievo
