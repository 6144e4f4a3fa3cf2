// SPDX-License-Identifier: Apache-2.0
// A queue of packets for the decoder, and the last packets of all subtitle streams, for a viewer who changes to
// another.
#include "app/media/tracks/subtitle_track.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace relievo {
namespace {

constexpr std::size_t kMostBytesBefore = std::size_t{8} << 20;  // a USB stick with 30 MB/s needs .3 s for them
constexpr int kTriesBefore = 3;
constexpr Duration kLeastBefore = std::chrono::milliseconds(250);

}  // namespace

Result<void> SubtitleTrack::open(std::unique_ptr<SubtitleDecoder> decoder, const StreamInfo& stream, Duration before) {
  close();
  if (auto opened = decoder->open(stream); !opened) return opened;
  decoder_ = std::move(decoder);
  stream_ = stream.index;
  before_ = before;
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

void SubtitleTrack::readBefore(MediaSource& source, int leading, MediaTime target) {
  if (stream_ < 0 || before_ == Duration(0) || target <= MediaTime{}) return;
  Duration before = before_;
  std::optional<MediaTime> begun;
  for (int tries = 0; tries < kTriesBefore; ++tries, before = std::min(before / 2, before_)) {
    const MediaTime from = std::max(MediaTime{}, target - before);
    waiting_.clear();
    if (!source.seek(from)) return;
    std::optional<MediaTime> first;
    MediaTime reached;
    for (std::size_t bytes = 0; bytes < kMostBytesBefore;) {
      auto packet = source.read();
      if (!packet || !*packet) return;
      bytes += (*packet)->bytes;
      const auto time = (*packet)->dts ? (*packet)->dts : (*packet)->pts;
      if ((*packet)->stream == leading && time) {
        reached = *time;
        if (!first) first = reached;
      }
      if (reached >= target) return;
      if ((*packet)->stream == stream_) keep(std::move(**packet));
    }
    // From a key frame on, which may be long before `from`: what so many bytes last, and not how far they came.
    const Duration covered = reached - first.value_or(reached);
    before_ = std::min(before_, std::max(covered / 2, kLeastBefore));
    if (tries > 0 && first == begun) return;  // the same key frame: no nearer one is to be had
    begun = first;
  }
}

}  // namespace relievo
