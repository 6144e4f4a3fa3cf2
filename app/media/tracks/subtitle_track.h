// SPDX-License-Identifier: Apache-2.0
// The subtitles of a film: packets are queued as they are read with the pictures, and decoded on request.
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

  // Opens the decoder for `stream`, in place of the last one.
  [[nodiscard]] Result<void> open(std::unique_ptr<SubtitleDecoder> decoder, const StreamInfo& stream);
  void close() noexcept;
  [[nodiscard]] int stream() const noexcept { return stream_; }
  void keep(Packet packet);
  [[nodiscard]] std::optional<Subtitle> next();
  // Call after a seek.
  void restart();

 private:
  std::unique_ptr<SubtitleDecoder> decoder_;
  int stream_ = -1;
  std::deque<Packet> waiting_;
};

}  // namespace relievo
