// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/opening/seeks.h"

#include <algorithm>
#include <span>
#include <string_view>

#include "drivers/ffmpeg/container.h"
#include "drivers/ffmpeg/library.h"

namespace relievo::ffmpeg {
namespace {

int seekTo(AVFormatContext& context, const AVStream& stream, Duration time) noexcept {
  const std::int64_t ticks = av_rescale_q(time.count(), kNanosecond, stream.time_base);
  return av_seek_frame(&context, stream.index, ticks, AVSEEK_FLAG_BACKWARD);
}

Duration latestStart(const AVFormatContext& context, Duration start) noexcept {
  for (const AVStream* const stream : std::span(context.streams, context.nb_streams)) {
    if (stream->start_time != AV_NOPTS_VALUE)
      start = std::max(start, durationFrom(stream->start_time, stream->time_base));
  }
  return start;
}

}  // namespace

bool seeksByBytes(const AVFormatContext& context) noexcept {
  return (context.iformat->flags & (AVFMT_TS_DISCONT | AVFMT_NO_BYTE_SEEK)) == AVFMT_TS_DISCONT;
}

// In a transport stream the codec's tag is the stream's type, one byte.
bool isListOfMp4(const AVFormatContext& context) noexcept {
  if (std::string_view(context.iformat->name) != "hls" || context.duration <= 0) return false;
  return std::ranges::any_of(std::span(context.streams, context.nb_streams),
                             [](const AVStream* stream) { return stream->codecpar->codec_tag > 0xff; });
}

bool haveSameStreams(const AVFormatContext& a, const AVFormatContext& b) noexcept {
  return std::ranges::equal(
      std::span(a.streams, a.nb_streams), std::span(b.streams, b.nb_streams), [](const AVStream* x, const AVStream* y) {
        return x->codecpar->codec_type == y->codecpar->codec_type && x->codecpar->codec_id == y->codecpar->codec_id;
      });
}

bool hasSubtitles(const AVFormatContext& context) noexcept {
  return std::ranges::any_of(std::span(context.streams, context.nb_streams),
                             [](const AVStream* stream) { return kindOf(*stream) == StreamKind::Subtitle; });
}

// The second try is for a target too near the end, the third for one before a list's first packet: FFmpeg refuses it,
// and the stream that begins first need not have that packet.
int seekByKeyFrames(AVFormatContext& context, const SoughtPlace& place) noexcept {
  const bool onwards = place.target > MediaTime{};
  const Duration time = place.target.time_since_epoch() + place.start;
  const Duration last_second = place.start + std::max(Duration(0), place.length - std::chrono::seconds(1));
  const AVStream& stream = *context.streams[onwards ? place.leading : place.earliest];
  int sought = seekTo(context, stream, time);
  if (sought < 0) sought = seekTo(context, stream, std::min(time, last_second));
  const Duration first = latestStart(context, place.start);
  if (sought < 0 && time < first) sought = seekTo(context, stream, first);
  return sought;
}

}  // namespace relievo::ffmpeg
