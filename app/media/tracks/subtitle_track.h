// SPDX-License-Identifier: Apache-2.0
// The subtitles of a film: packets are queued as they are read with the pictures, and decoded on request. Those of all
// tracks read lately are remembered, so that a track shows the line that already runs when it is switched on.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>

#include "hal/media/media_source.h"
#include "hal/media/subtitle_decoder.h"
#include "platform/error.h"

namespace relievo {

// Use from one thread. Packets that are not requested in time are dropped, the oldest first.
class SubtitleTrack {
 public:
  static constexpr std::size_t kMaxWaiting = 1024;
  static constexpr std::size_t kMaxRecent = 256, kMaxRecentBytes = std::size_t{1} << 20;

  // Opens the decoder for `stream`, in place of the last one. What is remembered of the stream comes first. `before` is
  // what readBefore reads.
  [[nodiscard]] Result<void> open(std::unique_ptr<SubtitleDecoder> decoder, const StreamInfo& stream, Duration before);
  void close() noexcept;
  [[nodiscard]] int stream() const noexcept { return stream_; }
  // Takes a packet of any subtitle stream, selected or not.
  void keep(Packet packet);
  [[nodiscard]] std::optional<Subtitle> next();
  // Call after a seek. Subtitles that were read before it are kept, since their times stay valid.
  void restart();
  // Call after restart and before the source's own seek: a line that runs at the target may begin before the key frame
  // that the pictures are decoded from. Where the film has too many bytes a second, less than `before` is read, now and
  // from then on. Errors are those of the seek that follows. `leading` is the stream of the pictures.
  void readBefore(MediaSource& source, int leading, MediaTime target);

 private:
  std::unique_ptr<SubtitleDecoder> decoder_;
  int stream_ = -1;
  Duration before_{0};
  std::deque<Packet> waiting_;  // of the selected stream
  std::deque<Packet> recent_;   // of all of them
  std::size_t recent_bytes_ = 0;
};

}  // namespace relievo
