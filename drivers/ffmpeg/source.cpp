// SPDX-License-Identifier: Apache-2.0
// Media source on libavformat: describes a container, reads it, seeks; every wait is interruptible and has a time-out.
#include <algorithm>
#include <cerrno>
#include <deque>
#include <map>
#include <span>
#include <string_view>
#include <thread>
#include <utility>

#include "drivers/ffmpeg/container.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/file_times.h"
#include "drivers/ffmpeg/library.h"
#include "drivers/ffmpeg/opening/opening.h"
#include "drivers/ffmpeg/opening/seeks.h"
#include "drivers/ffmpeg/pictures/photo_size.h"
#include "drivers/ffmpeg/refusal.h"
#include "drivers/ffmpeg/stream_tags.h"
#include "drivers/ffmpeg/watch.h"

extern "C" {
#include <libavformat/avformat.h>
#include <libavutil/mathematics.h>
}

namespace relievo {
namespace {

using namespace ffmpeg;

constexpr Duration kFlowPatience = std::chrono::seconds(3);  // for a real-time stream
constexpr Duration kNap = std::chrono::milliseconds(2);      // between retries after AVERROR(EAGAIN)
constexpr const char* kCannotSeek =
    "a live stream, a pipe, or a server that gives only whole files cannot seek; save it to a file first";
constexpr std::size_t kTagPackets = 512;  // searched for a key frame of each stream
// In a real-time stream: relievo-author's key frames are up to two seconds apart.
constexpr Duration kFlowTagTime = std::chrono::milliseconds(2500);
constexpr int kDamagedReads = 64;  // in a row, until a broken container counts as ended
// A longer gap in the times counts as a jump and is closed. A shorter one is lost data: the player waits for its
// length, unless the stream is in real time, where that time has already passed.
constexpr Duration kLongestGap = std::chrono::seconds(10);
constexpr Duration kLongestFlowGap = std::chrono::seconds(2);

class FfmpegSource final : public MediaSource {
 public:
  FfmpegSource() noexcept { silenceLibrary(); }
  ~FfmpegSource() override { close(); }

 private:
  Result<Description> openSource(const std::string& url) override {
    opener_.forgive();
    url_ = url;
    if (const auto opened = openContext(); !opened) return std::unexpected(opened.error());
    return describe();
  }

  // If it fails, the previously open context stays open.
  Result<void> openContext() {
    auto opened = opener_.open(url_);
    if (!opened) return std::unexpected(opened.error());
    AVFormatContext& context = *opened->container;
    arrival_ = opened->arrival;
    timed_ = isTimed(context);
    chooseProgramme(context);
    start_ = startOf(context);
    end_.open(context, start_);
    sought_ = false;
    fresh_ = true;
    leading_stream_ = std::max(av_find_default_stream_index(&context), 0);
    earliest_stream_ = earliestStream(context, leading_stream_);
    context_ = std::move(opened->container);
    address_ = std::move(opened->address);
    beginTimes();
    readStreamTags();
    return {};
  }

  // If the container has no depth tags, looks for tags at the streams' first key frames. The packets read for that are
  // kept; FFmpeg has read most of them already.
  void readStreamTags() {
    stream_tags_.clear();
    auto wanted = streamsWithTags(*context_);
    std::optional<MediaTime> begin;
    while (!wanted.empty() && ahead_.size() < kTagPackets) {
      PacketPtr packet(av_packet_alloc());
      if (!packet || opener_.input().readFrame(*context_, *packet) < 0) return;  // `readPacket` gets the error again
      const auto found = wanted.find(packet->stream_index);
      if (found != wanted.end() && (packet->flags & AV_PKT_FLAG_KEY) != 0) {
        stream_tags_[found->first] = streamTags(*packet, *found->second->codecpar);
        wanted.erase(found);
      }
      const auto time = timeOf(packet->dts, *context_->streams[packet->stream_index]);
      const bool leads = packet->stream_index == leading_stream_;
      ahead_.push_back(std::move(packet));
      if (!leads || !time || !address_.flows()) continue;
      if (!begin) begin = time;
      if (*time - *begin > kFlowTagTime) return;
    }
  }

  Result<Description> describe() const {
    Description description;
    description.tags = tagsOf(context_->metadata);
    if (timed_) description.duration = lengthOf(*context_, start_);
    description.origin = origin();
    description.chapters = chaptersOf(*context_, start_);
    for (unsigned i = 0; i < context_->nb_streams; ++i) {
      auto stream = describeStream(*context_->streams[i], timed_, isOfPhotos(*context_->iformat));
      if (!stream) return std::unexpected(stream.error());
      if (auto note = isOfPhotos(*context_->iformat) ? halveSize(*stream) : std::nullopt)
        description.notes.push_back(std::move(*note));
      if (stream->duration == Duration(0)) stream->duration = description.duration;
      if (const auto own = stream_tags_.find(stream->index); own != stream_tags_.end()) {
        stream->tags.insert(own->second.begin(), own->second.end());
      }
      description.streams.push_back(std::move(*stream));
    }
    return description;
  }

  [[nodiscard]] Origin origin() const noexcept {
    Origin origin{.remote = address_.remote(), .arrival = arrival_};
    if ((context_->iformat->flags & AVFMT_TS_DISCONT) != 0 || address_.flows()) {
      origin.longest_gap = address_.flows() ? kLongestFlowGap : kLongestGap;
    }
    // An RTSP session's times begin at 0 for each client; a transport stream's are the sender's clock.
    if (address_.way != Way::Rtsp && timed_) origin.sender_start = start_;
    return origin;
  }

  Result<std::optional<Packet>> readPacket() override {
    watch().begin(address_.flows() ? kFlowPatience : kReadPatience, lateReading(address_.way));
    opener_.input().beginReading();
    PacketPtr packet(av_packet_alloc());
    if (!packet) return fail(ErrorCode::Exhausted, "out of memory for a packet", ENOMEM);
    int damaged_reads = 0;
    for (;;) {
      if (watch().cancelled()) return std::unexpected(watch().explain({}));
      const int got = readNext(packet);
      if (got >= 0 && context_->pb != nullptr) context_->pb->error = 0;  // recovered
      if (got >= 0 && isWanted(*packet)) return packetOf(std::move(packet));
      if (got >= 0) {
        av_packet_unref(packet.get());
      } else if (got == AVERROR(EAGAIN) && !watch().givesUp()) {
        std::this_thread::sleep_for(kNap);
      } else if (got != AVERROR_INVALIDDATA || ++damaged_reads >= kDamagedReads) {
        if (timed_) end_.reach(*context_, opener_.input().isDoubtful());
        return endOrError(got);
      }
    }
  }

  // Returns FFmpeg's code, like av_read_frame.
  int readNext(PacketPtr& packet) {
    fresh_ = false;
    if (ahead_.empty()) return opener_.input().readFrame(*context_, *packet);
    packet = std::move(ahead_.front());
    ahead_.pop_front();
    return 0;
  }

  // A subtitle that begins before the sought position is not read, and may be what lasts until the film's end.
  Duration missingTime() const noexcept override {
    return gaps_.missing() + (sought_ && hasSubtitles(*context_) ? Duration(0) : end_.missing());
  }

  // False for packets with only side data, and for those of another programme that were read before this one was
  // chosen.
  bool isWanted(const AVPacket& packet) const noexcept {
    return packet.size > 0 && context_->streams[packet.stream_index]->discard != AVDISCARD_ALL;
  }

  // FFmpeg reports a broken connection as the end as well; its I/O context, if any, has the real error. A real-time
  // stream without a duration does not end.
  Result<std::optional<Packet>> endOrError(int code) const {
    const int io_error = context_->pb == nullptr || context_->pb->error == AVERROR_EOF ? 0 : context_->pb->error;
    const bool endless = address_.flows() && context_->duration <= 0;
    if (io_error == 0 && !endless && (code == AVERROR_EOF || code == AVERROR_INVALIDDATA)) return std::nullopt;
    if (code == AVERROR(ENOMEM)) return fail(ErrorCode::Exhausted, "out of memory for a packet", ENOMEM);
    return std::unexpected(watch().explain({ErrorCode::Lost, osError(io_error != 0 ? io_error : code),
                                            "the source went away during playback; check disk or network"}));
  }

  std::optional<Packet> packetOf(PacketPtr packet) {
    const AVStream& stream = *context_->streams[packet->stream_index];
    Packet out;
    out.stream = packet->stream_index;
    out.data = packet->data;
    out.bytes = static_cast<std::size_t>(packet->size);
    out.pts = timeOf(packet->pts, stream);
    out.dts = timeOf(packet->dts, stream);
    if (origin().longest_gap == Duration(0)) times_.mend(out, url_);
    noteLosses(out, *packet);
    out.keyframe = (packet->flags & AV_PKT_FLAG_KEY) != 0;
    out.owner = std::shared_ptr<AVPacket>(std::move(packet));
    return out;
  }

  // By times that do not jump, as MediaSource makes them.
  void noteLosses(Packet out, const AVPacket& packet) {
    const AVStream& stream = *context_->streams[packet.stream_index];
    const bool is_subtitle = kindOf(stream) == StreamKind::Subtitle;
    const Duration offset = out.dts ? continuous_.offsetFor(out.stream, *out.dts) : Duration(0);
    if (out.dts) *out.dts += offset;
    if (out.pts) *out.pts += offset;
    const Duration stated = durationFrom(packet.duration, stream.time_base);
    const Duration length = is_subtitle ? stated : lengths_.of(out, stated);
    end_.note(out, length, (packet.flags & AV_PKT_FLAG_CORRUPT) != 0, packet.pos);
    if (address_.flows() || is_subtitle) return;
    gaps_.note(out, length, opener_.input().doubtOf(packet, stream), opener_.input().losses(), url_);
  }

  void beginTimes() noexcept {
    ahead_.clear();
    times_.begin();
    lengths_.begin();
    gaps_.begin();
    continuous_.begin(origin().longest_gap);
  }

  std::optional<MediaTime> timeOf(std::int64_t time, const AVStream& stream) const noexcept {
    if (time == AV_NOPTS_VALUE || !timed_) return std::nullopt;
    return MediaTime(durationFrom(time, stream.time_base) - start_);
  }

  Result<void> seekTo(MediaTime target) override {
    if (watch().cancelled()) return std::unexpected(watch().explain({}));
    const bool in_vain =
        seeksByBytes(*context_) && context_->pb != nullptr && (context_->pb->seekable & AVIO_SEEKABLE_NORMAL) == 0;
    if (in_vain && fresh_) return {};  // FFmpeg would stay at its place and call that sought, as here is right
    if (opener_.input().isPipe() || in_vain) return fail(ErrorCode::Unsupported, kCannotSeek);
    if (!timed_) return openContext();  // pictures without times are counted from the beginning
    if (isListOfMp4(*context_)) return seekInList(target);
    watch().begin(kReadPatience, lateReading(address_.way));
    const bool onwards = target > MediaTime{};
    int sought =
        !onwards && seeksByBytes(*context_) ? av_seek_frame(context_.get(), -1, 0, AVSEEK_FLAG_BYTE) : AVERROR(ENOSYS);
    const SoughtPlace place{target, start_, duration(), leading_stream_, earliest_stream_};
    if (sought < 0) sought = seekByKeyFrames(*context_, place);
    if (sought < 0) return std::unexpected(watch().explain({ErrorCode::Unsupported, osError(sought), kCannotSeek}));
    opener_.input().beginElsewhere();
    beginAt(target);
    return {};
  }

  void beginAt(MediaTime target) noexcept {
    beginTimes();
    end_.seek(target);
    sought_ = target > MediaTime{};
  }

  // The times stay those of the whole film.
  Result<void> seekInList(MediaTime target) {
    constexpr Duration kEarlier = std::chrono::milliseconds(100);  // a list rounds the lengths of its parts
    const Duration last_second = duration() - std::chrono::seconds(1);
    auto opened = opener_.open(url_, std::min(target.time_since_epoch() - kEarlier, last_second), context_.get());
    if (!opened) return std::unexpected(opened.error());
    context_ = std::move(opened->container);
    chooseProgramme(*context_);
    beginAt(target);
    return {};
  }

  void closeSource() noexcept override {
    ahead_.clear();
    context_.reset();
    opener_.input().closePipe();
  }

  void interrupted() noexcept override { opener_.interrupt(); }
  [[nodiscard]] Watch& watch() const noexcept { return opener_.input().watch(); }

  std::string url_;
  Address address_;
  MonotonicTime arrival_;
  Opener opener_;
  FormatPtr context_;
  bool timed_ = true;
  Duration start_{0};    // the container's start time
  bool sought_ = false;  // since it was opened, and not to the beginning
  bool fresh_ = true;    // nothing has been read since then
  FileTimes times_;
  PacketLengths lengths_;
  FileGaps gaps_;
  ContinuousTime continuous_;  // where a container's times may jump
  FileEnd end_;
  std::deque<PacketPtr> ahead_;                                    // read while looking for tags, not returned yet
  std::map<int, std::map<std::string, std::string>> stream_tags_;  // by stream index
  int leading_stream_ = 0, earliest_stream_ = 0;
};

}  // namespace

std::unique_ptr<MediaSource> makeFfmpegSource() {
  return std::make_unique<FfmpegSource>();
}

}  // namespace relievo
