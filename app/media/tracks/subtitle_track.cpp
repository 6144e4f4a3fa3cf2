// SPDX-License-Identifier: Apache-2.0
// A queue before a decoder, and one of what has been read lately.
#include "app/media/tracks/subtitle_track.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace relievo {

Result<void> SubtitleTrack::open(std::unique_ptr<SubtitleDecoder> decoder, const StreamInfo& stream) {
  close();
  if (auto opened = decoder->open(stream); !opened) return opened;
  decoder_ = std::move(decoder);
  stream_ = stream.index;
  std::ranges::copy_if(recent_, std::back_inserter(waiting_), [this](const Packet& p) { return p.stream == stream_; });
  return {};
}

void SubtitleTrack::close() noexcept {
  decoder_.reset();
  stream_ = -1;
  waiting_.clear();
}

void SubtitleTrack::keep(Packet packet) {
  if (packet.stream == stream_) waiting_.push_back(packet);
  if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
  recent_bytes_ += packet.bytes;
  recent_.push_back(std::move(packet));
  while (recent_.size() > kMaxRecent || recent_bytes_ > kMaxRecentBytes) {
    recent_bytes_ -= recent_.front().bytes;
    recent_.pop_front();
  }
}

std::optional<Subtitle> SubtitleTrack::next() {
  while (decoder_ != nullptr && !waiting_.empty()) {
    auto subtitle = decoder_->decode(waiting_.front());
    waiting_.pop_front();
    if (subtitle) return subtitle;
  }
  return std::nullopt;
}

void SubtitleTrack::restart() {
  waiting_.clear();
  if (decoder_ != nullptr) decoder_->flush();
}

}  // namespace relievo
