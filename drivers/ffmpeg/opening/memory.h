// SPDX-License-Identifier: Apache-2.0
// What a source may take while it is opened. Lists of local films are bounded before FFmpeg reads them (bounds/); those
// of servers and of other containers are not, and can say that a track has any number of pictures.
#pragma once

#include <cstddef>
#include <mutex>

#include "platform/error.h"

namespace relievo::ffmpeg {

// Pictures of 4096 x 4096 in four channels of 32 bits take 540 MB while they are analysed.
inline constexpr std::size_t kMostOpeningBytes = 800'000'000;
inline constexpr Error kTooMuchMemory{ErrorCode::Exhausted, 0,
                                      "to open it would take over 800 MB of memory: its lists are damaged, or made to "
                                      "do harm; check where it is from"};

class OpeningMemory {
 public:
  OpeningMemory();

  // Call on the thread that opens it, before it does.
  void begin();
  // Whether the process has grown by more than that since the construction, without what it shares or has mapped from
  // files, and that thread has taken at least half of it. From then on FFmpeg gets no large block, until `end`: it
  // fails, which nothing else makes it do in time. While another source is open, or a decoder, they get theirs, and it
  // goes on. Not after `end`, nor where the kernel gives whole huge pages unasked: they are not told by thread.
  [[nodiscard]] bool exceeded();
  // The opening is over, or left behind. Returns whether it was exceeded.
  bool end();

 private:
  const std::size_t before_;
  std::mutex mutex_;  // guards what follows
  bool exceeded_ = false, ended_ = false;
  int thread_ = 0;  // 0: not begun
  std::size_t taken_before_ = 0;
};

}  // namespace relievo::ffmpeg
