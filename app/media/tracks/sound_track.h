// SPDX-License-Identifier: Apache-2.0
// The sound of a film: packets are queued as they are read with the pictures, and decoded on request.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>

#include "hal/media/audio_decoder.h"
#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo {

// Use from one thread. Sound never delays the pictures: packets that are not requested in time are dropped, the oldest
// first, and a decoder failure ends the sound alone.
class SoundTrack {
 public:
  // More than a minute of any compressed codec; less of uncompressed sound.
  static constexpr std::size_t kMaxWaitingPackets = 4096;
  static constexpr std::size_t kMaxWaitingBytes = std::size_t{16} << 20;

  // Opens the decoder for `stream`, in place of the last one.
  [[nodiscard]] Result<void> open(std::unique_ptr<AudioDecoder> decoder, const StreamInfo& stream,
                                  const AudioFormat& format);
  [[nodiscard]] bool open() const noexcept { return decoder_ != nullptr; }
  [[nodiscard]] int stream() const noexcept { return stream_; }
  void keep(Packet packet);
  // The next samples of the queued sound, in order; nullopt if there are none.
  [[nodiscard]] std::optional<AudioChunk> next();
  // Call after a seek.
  void restart();
  [[nodiscard]] std::uint64_t damaged() const noexcept { return decoder_ == nullptr ? 0 : decoder_->damaged(); }

 private:
  std::unique_ptr<AudioDecoder> decoder_;
  int stream_ = -1;
  std::deque<Packet> waiting_;
  std::size_t waiting_bytes_ = 0;
};

}  // namespace relievo
