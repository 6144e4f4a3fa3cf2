// SPDX-License-Identifier: Apache-2.0
// Reads the decoded pictures of one or two video tracks of one source, each in order.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "hal/media_source.h"
#include "hal/video_decoder.h"
#include "platform/error.h"

namespace relievo {

// One open source and a decoder for each chosen track. Packets of the track that is not asked for at the moment are kept
// in a queue of bounded size. One thread.
class TrackReader {
 public:
  static constexpr std::size_t kMaxTracks = 2;
  TrackReader(std::unique_ptr<MediaSource> source, std::function<std::unique_ptr<VideoDecoder>()> make_decoder);

  [[nodiscard]] Result<void> open(const std::string& url);
  // Chooses a stream to be decoded; returns the track's number for `next`.
  [[nodiscard]] Result<std::size_t> select(const StreamInfo& stream);
  // The track's next picture in presentation order, or nothing at its end.
  [[nodiscard]] Result<std::optional<Frame>> next(std::size_t track);
  // To the key frame at or before `target`.
  [[nodiscard]] Result<void> seek(MediaTime target);
  void interrupt() noexcept { source_->interrupt(); }
  [[nodiscard]] const MediaSource& source() const noexcept { return *source_; }
  [[nodiscard]] std::uint64_t damaged() const noexcept;

 private:
  struct Track {
    int stream = -1;
    std::unique_ptr<VideoDecoder> decoder;
    std::deque<Packet> waiting;
  };
  [[nodiscard]] Result<bool> readOnePacket();

  std::unique_ptr<MediaSource> source_;
  std::function<std::unique_ptr<VideoDecoder>()> make_decoder_;
  std::array<Track, kMaxTracks> tracks_;
  std::size_t track_count_ = 0;
};

}  // namespace relievo
