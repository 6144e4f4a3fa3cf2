// SPDX-License-Identifier: Apache-2.0
// A bounded queue of packets before the sound decoder.
#include "app/media/tracks/sound_track.h"

#include <utility>

#include "platform/log.h"

namespace relievo {

Result<void> SoundTrack::open(std::unique_ptr<AudioDecoder> decoder, const StreamInfo& stream,
                              const AudioFormat& format) {
  restart();
  decoder_.reset();
  stream_ = -1;
  if (auto opened = decoder->open(stream, format); !opened) return opened;
  decoder_ = std::move(decoder);
  stream_ = stream.index;
  return {};
}

void SoundTrack::keep(Packet packet) {
  waiting_bytes_ += packet.bytes;
  waiting_.push_back(std::move(packet));
  while (waiting_.size() > kMaxWaitingPackets || waiting_bytes_ > kMaxWaitingBytes) {
    waiting_bytes_ -= waiting_.front().bytes;
    waiting_.pop_front();
  }
}

std::optional<AudioChunk> SoundTrack::next() {
  while (decoder_ != nullptr && !waiting_.empty()) {
    auto chunk = decoder_->decode(waiting_.front());
    waiting_bytes_ -= waiting_.front().bytes;
    waiting_.pop_front();
    if (!chunk) {
      log(LogLevel::Warning, "media", "no sound from here on: %s", chunk.error().message);
      decoder_.reset();
      stream_ = -1;
    } else if (!chunk->samples.empty()) {
      return std::move(*chunk);
    }
  }
  return std::nullopt;
}

void SoundTrack::restart() {
  waiting_.clear();
  waiting_bytes_ = 0;
  if (decoder_ != nullptr) static_cast<void>(decoder_->flush());  // cannot fail on an open decoder
}

}  // namespace relievo
