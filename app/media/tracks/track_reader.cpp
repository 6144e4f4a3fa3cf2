// SPDX-License-Identifier: Apache-2.0
// Passes packets of one source to the decoders of its tracks, with bounded queues between.
#include "app/media/tracks/track_reader.h"

#include <algorithm>
#include <utility>

#include "app/media/tracks/deinterlaced.h"
#include "app/media/tracks/turned.h"

namespace relievo {
namespace {

constexpr Duration kFirstStepBack = std::chrono::seconds(1);

// The picture as `change` makes it, and the right eye's with it.
template <class Change>
Result<Frame> changed(const Frame& frame, Change change) {
  auto made = change(frame);
  if (!made || !frame.right) return made;
  auto right = change(*frame.right);
  if (!right) return right;
  made->right = std::make_shared<const Frame>(std::move(*right));
  return made;
}

}  // namespace

TrackReader::TrackReader(std::unique_ptr<MediaSource> source,
                         std::function<std::unique_ptr<VideoDecoder>(const StreamInfo&)> make_decoder)
    : source_(std::move(source)), make_decoder_(std::move(make_decoder)) {}

Result<void> TrackReader::open(const std::string& url, std::optional<double> frames_per_s) {
  source_->setPictureRate(frames_per_s);
  return source_->open(url);
}

Result<std::size_t> TrackReader::select(const StreamInfo& stream) {
  if (track_count_ == kMaxTracks) return fail(ErrorCode::Exhausted, "three tracks of this source are already selected");
  Track track;
  track.stream = stream.index;
  track.rotation = stream.rotation;
  track.decoder = make_decoder_(stream);
  if (auto opened = track.decoder->open(stream); !opened) return std::unexpected(opened.error());
  tracks_[track_count_] = std::move(track);
  return track_count_++;
}

Result<std::optional<Frame>> TrackReader::next(std::size_t number) {
  Track& track = tracks_[number];
  if (track.found) return std::exchange(track.found, std::nullopt);
  return decode(track);
}

bool TrackReader::ended(std::size_t number) const noexcept {
  return tracks_[number].finished && tracks_[number].decoder->state() == VideoDecoder::State::Ended;
}

std::uint64_t TrackReader::damaged() const noexcept {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < track_count_; ++i) sum += tracks_[i].decoder->damaged();
  return sum + sound_.damaged();
}

std::optional<VideoDecoder::Restart> TrackReader::takeRestart() noexcept {
  for (std::size_t i = 0; i < track_count_; ++i) {
    if (auto restart = tracks_[i].decoder->takeRestart()) return restart;
  }
  return std::nullopt;
}

Result<std::optional<Frame>> TrackReader::receiveWhole(Track& track) {
  auto frame = track.decoder->receive();
  if (frame && *frame && (*frame)->interlaced) {
    frame = changed(**frame, relievo::deinterlaced);
    ++deinterlaced_;
  }
  if (track.rotation == 0 || !frame || !*frame) return frame;
  return changed(**frame, [&](const Frame& picture) { return turned(picture, track.rotation); });
}

Result<std::optional<Frame>> TrackReader::decode(Track& track) {
  for (;;) {
    auto frame = receiveWhole(track);
    if (frame && *frame && &track == tracks_.data()) given_ = (*frame)->pts;
    if (!frame || *frame) return frame;
    if (track.decoder->state() == VideoDecoder::State::Draining) continue;
    if (track.decoder->state() == VideoDecoder::State::Ended) {
      if (track.finished) return frame;
      if (auto flushed = track.decoder->flush(); !flushed) return std::unexpected(flushed.error());
    }
    const auto fed = feed(track);
    if (!fed) return std::unexpected(fed.error());
    if (!*fed) return std::nullopt;
  }
}

// Gives the decoder one packet or the end of the stream; false if neither is available now.
Result<bool> TrackReader::feed(Track& track) {
  const bool leads = &track == tracks_.data();
  while (track.waiting.empty()) {
    if (!leads && isFull(tracks_[0])) return false;
    const auto read = readOnePacket();
    if (!read) return std::unexpected(read.error());
    if (*read) continue;
    track.finished = true;
    if (auto draining = track.decoder->drain(); !draining) return std::unexpected(draining.error());
    return true;
  }
  const Packet& packet = track.waiting.front();
  const auto fed = track.decoder->feed(packet);
  if (!fed) return std::unexpected(fed.error());
  if (*fed == Feed::Full) {  // full, yet it had no picture to return
    return fail(ErrorCode::Exhausted, "all of the decoder's pictures are held; release some first");
  }
  track.waiting_bytes -= packet.bytes;
  track.waiting.pop_front();
  if (key_step_ == Duration(0)) return true;
  if (auto draining = track.decoder->drain(); !draining) return std::unexpected(draining.error());
  return true;
}

// False at the end of the source.
Result<bool> TrackReader::readOnePacket() {
  waits_for_source_ = true;
  auto packet = source_->read();
  waits_for_source_ = false;
  if (!packet) return std::unexpected(packet.error());
  if (!*packet) return false;
  const Packet& read = **packet;
  if (read.stream == sound_.stream()) {
    sound_.keep(std::move(**packet));
    return true;
  }
  if (isWords(read.stream)) {
    words_.keep(std::move(**packet));
    return true;
  }
  if (read.stream == tracks_[0].stream) read_ = read.dts ? read.dts : read.pts;
  for (std::size_t i = 0; i < track_count_; ++i) {
    if (tracks_[i].stream == (*packet)->stream) keep(tracks_[i], std::move(**packet));
  }
  return true;
}

bool TrackReader::isWords(int stream) const {
  return std::ranges::any_of(source_->streams(), [stream](const StreamInfo& each) {
    return each.index == stream && each.kind == StreamKind::Subtitle;
  });
}

bool TrackReader::isWanted(Track& track, const Packet& packet) const {
  if (key_step_ == Duration(0)) return true;
  if (!packet.keyframe) return false;
  const auto time = packet.pts ? packet.pts : packet.dts;
  if (time && track.last_key && *time < *track.last_key + key_step_) return false;
  track.last_key = time;
  return true;
}

bool TrackReader::readAhead() {
  if (!sound_.open() || !given_ || !read_ || *read_ > *given_ + kReadAhead) return false;
  if (std::any_of(tracks_.begin(), tracks_.end(), isFull)) return false;
  const auto read = readOnePacket();
  return read && *read;
}

void TrackReader::keep(Track& track, Packet packet) {
  if (!isWanted(track, packet)) return;
  if (isFull(track)) {
    track.waiting.clear();
    track.waiting_bytes = 0;
    track.awaits_keyframe = true;
  }
  if (track.awaits_keyframe && !packet.keyframe) {
    track.passed_over = true;
    return;
  }
  track.awaits_keyframe = false;
  track.waiting_bytes += packet.bytes;
  track.waiting.push_back(std::move(packet));
}

void TrackReader::leaveOutUnreferenced(bool leave_out) {
  // It fails only if no track has been selected yet.
  static_cast<void>(tracks_[0].decoder->leaveOutUnreferenced(leave_out));
}

Result<bool> TrackReader::hurryTo(MediaTime until) {
  Track& lead = tracks_[0];
  while (!isFull(lead) && (!read_ || *read_ <= until)) {
    const auto read = readOnePacket();
    if (!read) return std::unexpected(read.error());
    if (!*read) break;
  }
  const auto landing = dropBeforeKey(lead, until);
  if (!landing) return std::unexpected(landing.error());
  if (!*landing) return false;
  for (std::size_t i = 1; i < track_count_; ++i) {
    if (const auto dropped = dropBeforeKey(tracks_[i], **landing); !dropped) return std::unexpected(dropped.error());
  }
  return true;
}

// The time of the key frame that is now the next packet; nullopt if there is none ahead, or if pictures could not be
// identified by their times.
Result<std::optional<MediaTime>> TrackReader::dropBeforeKey(Track& track, MediaTime until) {
  if (track.decoder->state() != VideoDecoder::State::Open) return std::nullopt;
  const auto key = std::find_if(track.waiting.rbegin(), track.waiting.rend(), [&](const Packet& packet) {
    return packet.keyframe && packet.pts && *packet.pts <= until;
  });
  if (key == track.waiting.rend() || key + 1 == track.waiting.rend()) return std::nullopt;
  const MediaTime landing = *key->pts;
  const auto first = key.base() - 1;
  for (auto packet = track.waiting.begin(); packet != first; ++packet) track.waiting_bytes -= packet->bytes;
  track.waiting.erase(track.waiting.begin(), first);
  if (auto flushed = track.decoder->flush(); !flushed) return std::unexpected(flushed.error());
  return landing;
}

bool TrackReader::isFull(const Track& track) noexcept {
  return track.waiting.size() >= kMaxWaitingPackets || track.waiting_bytes >= kMaxWaitingBytes;
}

// Containers seek by one track, and some by decoding time, so another track or this track's reordered pictures may then
// begin after the target. Retries from ever earlier times, finally from the beginning.
Result<void> TrackReader::seek(MediaTime target, Duration key_step) {
  words_.restart();
  if (key_step == Duration(0)) words_.readBefore(*source_, tracks_[0].stream, target);
  Duration step_back{0};
  for (;;) {
    const MediaTime from = std::max(MediaTime{}, target - step_back);
    const auto reached = seekOnce(from, target, key_step);
    if (!reached) return std::unexpected(reached.error());
    if (*reached || from == MediaTime{}) return {};
    step_back = step_back == Duration(0) ? kFirstStepBack : 2 * step_back;
  }
}

// True when every track has a picture at or before the target, or has ended.
Result<bool> TrackReader::seekOnce(MediaTime from, MediaTime target, Duration key_step) {
  if (auto sought = source_->seek(from); !sought) return std::unexpected(sought.error());
  key_step_ = key_step;
  sound_.restart();
  given_.reset();
  read_.reset();
  for (std::size_t i = 0; i < track_count_; ++i) {
    auto restarted = restart(tracks_[i], from > MediaTime{});
    if (!restarted) return std::unexpected(restarted.error());
  }
  bool reached = true;
  for (std::size_t i = 0; i < track_count_; ++i) {
    Track& track = tracks_[i];
    auto frame = decode(track);
    if (!frame) {
      // An error in the leading track ends the seek; the other track's error is reported when that track is read.
      if (i == 0 || frame.error().code == ErrorCode::Cancelled) return std::unexpected(frame.error());
      continue;
    }
    track.found = std::move(*frame);
    const bool early_enough = track.found && track.found->pts <= target;
    const bool gone = !track.found && !track.passed_over && from < target;
    reached = reached && (early_enough || gone);
  }
  return reached;
}

Result<void> TrackReader::restart(Track& track, bool await_keyframe) {
  track.found.reset();
  track.waiting.clear();
  track.waiting_bytes = 0;
  track.awaits_keyframe = await_keyframe;
  track.passed_over = false;
  track.finished = false;
  track.last_key.reset();
  return track.decoder->flush();
}

}  // namespace relievo
