// SPDX-License-Identifier: Apache-2.0
// The sound that belongs to a film: packets as they are read beside the pictures, decoded when they are asked for.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>

#include "hal/audio_decoder.h"
#include "hal/media_source.h"
#include "platform/error.h"

namespace relievo {

// One thread. It never makes the pictures wait: what nobody has asked for in time is dropped, the oldest first, and a
// decoder that fails ends the sound alone.
class SoundTrack {
 public:
  // A minute and more, of whatever codec; uncompressed sound less.
  static constexpr std::size_t kMaxWaitingPackets = 4096;
  static constexpr std::size_t kMaxWaitingBytes = std::size_t{16} << 20;

  // Opens the decoder for `stream`.
  [[nodiscard]] Result<void> open(std::unique_ptr<AudioDecoder> decoder, const StreamInfo& stream,
                                  const AudioFormat& format);
  [[nodiscard]] bool open() const noexcept { return decoder_ != nullptr; }
  [[nodiscard]] int stream() const noexcept { return stream_; }
  void keep(Packet packet);
  // The next samples in order, of what has been kept; nothing while there are none.
  [[nodiscard]] std::optional<AudioChunk> next();
  // For a seek.
  void restart();
  [[nodiscard]] std::uint64_t damaged() const noexcept { return decoder_ == nullptr ? 0 : decoder_->damaged(); }

 private:
  std::unique_ptr<AudioDecoder> decoder_;
  int stream_ = -1;
  std::deque<Packet> waiting_;
  std::size_t waiting_bytes_ = 0;
};

}  // namespace relievo
