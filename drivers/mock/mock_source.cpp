// SPDX-License-Identifier: Apache-2.0
// A film without a container: packets that contain only a frame's number, in the order of their times.
#include <algorithm>
#include <cstring>

#include "drivers/mock/mock.h"
#include "drivers/mock/mock_packet.h"

namespace relievo {
namespace {

constexpr const char* kAnyUrl = "*";

class MockSource final : public MediaSource {
 public:
  MockSource(std::map<std::string, MockMediaProfile> films, Clock& clock) : films_(std::move(films)), clock_(clock) {}

 private:
  struct Cursor {
    std::shared_ptr<const MockTrack> track;
    int next = 0;

    void skipMissing() {
      const auto& missing = track->missing;
      while (std::find(missing.begin(), missing.end(), next) != missing.end()) ++next;
    }
    [[nodiscard]] bool ended() const { return next >= track->frames; }
    [[nodiscard]] MediaTime place() const { return track->pts(next) + track->late; }  // in the film
  };

  Result<Description> openSource(const std::string& url) override {
    interrupted_ = false;
    const auto film = films_.contains(kAnyUrl) ? films_.find(kAnyUrl) : films_.find(url);
    if (film == films_.end()) return fail(ErrorCode::NotFound, "the mock source has no such film");
    profile_ = film->second;
    tracks_.clear();
    for (const MockTrack& track : profile_.tracks) tracks_.push_back({std::make_shared<const MockTrack>(track)});
    if (profile_.fail_open) return fail(*profile_.fail_open, "the mock source was told not to open");
    packets_ = 0;
    latest_end_ = MediaTime{};
    Description description{.streams = {}, .tags = profile_.tags, .duration = Duration(0)};
    for (Cursor& cursor : tracks_) {
      cursor.next = 0;
      cursor.skipMissing();
      description.streams.push_back(describe(cursor.track, static_cast<int>(description.streams.size())));
      description.duration = std::max(description.duration, description.streams.back().duration);
    }
    description.origin = {.remote = profile_.remote,
                          .longest_gap = profile_.longest_gap,
                          .arrival = clock_.now(),
                          .sender_start = profile_.sender_start};
    return description;
  }

  [[nodiscard]] StreamInfo describe(const std::shared_ptr<const MockTrack>& track, int index) const {
    StreamInfo stream;
    stream.index = index;
    stream.kind = track->kind;
    stream.codec = kMockCodec;
    if (track->kind == StreamKind::Video) {
      stream.width = track->width;
      stream.height = track->height;
    } else {
      stream.sample_rate_hz = 48000;
      stream.channels = 2;
    }
    stream.frame_period = track->frame_period;
    if (!profile_.live) stream.duration = track->frames * track->frame_period;
    stream.tags = track->tags;
    stream.native = track;
    return stream;
  }

  Result<std::optional<Packet>> readPacket() override {
    if (interrupted_) return fail(ErrorCode::Cancelled, "reading was interrupted");
    if (packets_ >= profile_.lose_after_packets) return fail(ErrorCode::Lost, "the mock source has gone away");
    if (packets_ >= profile_.end_after_packets) return std::nullopt;
    if (packets_ == profile_.stall_after_packets && !stalled_) {
      if (auto waited = stall(); !waited) return std::unexpected(waited.error());
    }
    Cursor* const first = earliest();
    if (first == nullptr) return std::nullopt;
    Packet packet = take(*first);
    ++packets_;
    return packet;
  }

  // Sleeps in short steps, so that an interruption is noticed.
  Result<void> stall() {
    const MonotonicTime end = clock_.now() + profile_.stall;
    while (clock_.now() < end) {
      if (interrupted_) return fail(ErrorCode::Cancelled, "reading was interrupted");
      clock_.sleepUntil(std::min(end, clock_.now() + std::chrono::milliseconds(1)));
    }
    stalled_ = true;
    return {};
  }

  Cursor* earliest() {
    Cursor* first = nullptr;
    for (Cursor& cursor : tracks_) {
      if (cursor.ended()) continue;
      if (first == nullptr || cursor.place() < first->place()) first = &cursor;
    }
    return first;
  }

  Packet take(Cursor& cursor) {
    const bool damaged = profile_.damaged_every != 0 && (packets_ + 1) % profile_.damaged_every == 0;
    const auto content = std::make_shared<const MockPacket>(MockPacket{cursor.next, damaged});
    Packet packet;
    packet.stream = static_cast<int>(&cursor - tracks_.data());
    packet.data = reinterpret_cast<const std::uint8_t*>(content.get());
    packet.bytes = sizeof(MockPacket);
    packet.pts = packet.dts = cursor.track->pts(cursor.next);
    packet.keyframe = cursor.next % std::max(cursor.track->keyframe_interval, 1) == 0;
    packet.owner = content;
    latest_end_ = std::max(latest_end_, *packet.pts + cursor.track->frame_period);
    if (packets_ >= profile_.jump_after_packets) *packet.pts += profile_.jump;
    if (profile_.wrap > Duration(0)) packet.pts = MediaTime(packet.pts->time_since_epoch() % profile_.wrap);
    packet.dts = packet.pts;
    ++cursor.next;
    cursor.skipMissing();
    return packet;
  }

  Result<void> seekTo(MediaTime target) override {
    if (interrupted_) return fail(ErrorCode::Cancelled, "seeking was interrupted");
    if (packets_ >= profile_.lose_after_packets) return fail(ErrorCode::Lost, "the mock source has gone away");
    if (profile_.live) return fail(ErrorCode::Unsupported, "a live source cannot seek");
    latest_end_ = target;  // what is skipped is not missing
    for (Cursor& cursor : tracks_) {
      const MockTrack& track = *cursor.track;
      const auto frame = (target - track.pts(0)) / track.frame_period;
      const int wanted = static_cast<int>(std::clamp<Duration::rep>(frame, 0, std::max(track.frames - 1, 0)));
      cursor.next = wanted - wanted % std::max(track.keyframe_interval, 1);
      cursor.skipMissing();
    }
    return {};
  }

  [[nodiscard]] Duration missingTime() const noexcept override {
    return latest_end_ < MediaTime(duration()) ? duration() - latest_end_.time_since_epoch() : Duration(0);
  }

  void closeSource() noexcept override { stalled_ = false; }
  void interrupted() noexcept override { interrupted_ = true; }

  const std::map<std::string, MockMediaProfile> films_;
  MockMediaProfile profile_;  // of the open film
  Clock& clock_;
  std::vector<Cursor> tracks_;
  std::uint64_t packets_ = 0;
  MediaTime latest_end_;  // of the packets returned
  bool stalled_ = false;
  std::atomic<bool> interrupted_{false};
};

}  // namespace

std::unique_ptr<MediaSource> makeMockSource(MockMediaProfile profile, Clock& clock) {
  return makeMockSources({{kAnyUrl, std::move(profile)}}, clock);
}

std::unique_ptr<MediaSource> makeMockSources(std::map<std::string, MockMediaProfile> films, Clock& clock) {
  return std::make_unique<MockSource>(std::move(films), clock);
}

}  // namespace relievo
