// SPDX-License-Identifier: Apache-2.0
// Reads libavformat's description of a container.
#include "drivers/ffmpeg/container.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "drivers/ffmpeg/library.h"
#include "drivers/ffmpeg/pictures/picture.h"
#include "platform/log.h"

extern "C" {
#include <libavutil/display.h>
#include <libavutil/opt.h>
#include <libavutil/stereo3d.h>
}

namespace relievo::ffmpeg {
namespace {

// A transport stream's stream type (ISO/IEC 13818-1, table 2-34), which FFmpeg stores as the codec tag.
constexpr std::uint32_t kAuxiliaryVideo = 0x1e;

// Azure Kinect's code for 16-bit gray in big endian, which FFmpeg takes for RGB of 15 bits.
constexpr std::uint32_t kGray16Big = MKTAG('b', '1', '6', 'g');
// Raw AVI's code for 16-bit gray in little endian, as cameras write it; FFmpeg misreads it as well.
constexpr std::uint32_t kGray16Little = MKTAG('Y', '1', '6', ' ');

Duration framePeriodOf(const AVStream& stream) noexcept {
  for (const AVRational rate : {stream.avg_frame_rate, stream.r_frame_rate}) {
    if (rate.num > 0 && rate.den > 0) return durationFrom(1, av_inv_q(rate));
  }
  return Duration(0);
}

// From the decoding time of a first picture to its presentation, of the stream where it is longest.
Duration decodingDelayOf(const AVFormatContext& context) noexcept {
  Duration longest{0};
  for (const AVStream* const stream : std::span(context.streams, context.nb_streams)) {
    longest = std::max(longest, stream->codecpar->video_delay * framePeriodOf(*stream));
  }
  return longest;
}

// In WMV each stream has the whole film's length, to which FFmpeg adds the stream's beginning.
Duration longestStreamOf(const AVFormatContext& context) noexcept {
  Duration longest{0};
  for (const AVStream* const stream : std::span(context.streams, context.nb_streams)) {
    if (stream->duration > 0) longest = std::max(longest, durationFrom(stream->duration, stream->time_base));
  }
  return longest;
}

std::string layoutOf(const AVChannelLayout& layout) {
  std::array<char, 64> text{};
  const bool known = layout.nb_channels > 0 && av_channel_layout_describe(&layout, text.data(), text.size()) > 0;
  return known ? text.data() : "";
}

// The side data that the container stores for a stream; null if absent or shorter than `bytes`.
const std::uint8_t* besideStream(const AVStream& stream, AVPacketSideDataType type, std::size_t bytes) noexcept {
#if LIBAVFORMAT_VERSION_INT >= AV_VERSION_INT(60, 15, 100)  // FFmpeg 6.1
  const AVCodecParameters& parameters = *stream.codecpar;
  const AVPacketSideData* const data =
      av_packet_side_data_get(parameters.coded_side_data, parameters.nb_coded_side_data, type);
  return data == nullptr || data->size < bytes ? nullptr : data->data;
#else
  std::size_t found = 0;
  const std::uint8_t* const data = av_stream_get_side_data(&stream, type, &found);
  return found < bytes ? nullptr : data;
#endif
}

// How two views are stored, in the words that FFmpeg has for Matroska's StereoMode; empty if the container does not
// say, or in a way that is not shown.
std::string stereoModeOf(const AVStream& stream) {
  const auto* const said =
      reinterpret_cast<const AVStereo3D*>(besideStream(stream, AV_PKT_DATA_STEREO3D, sizeof(AVStereo3D)));
  if (said == nullptr) return "";
  const bool inverted = (said->flags & AV_STEREO3D_FLAG_INVERT) != 0;
  if (said->type == AV_STEREO3D_SIDEBYSIDE) return inverted ? "right_left" : "left_right";
  if (said->type == AV_STEREO3D_TOPBOTTOM) return inverted ? "bottom_top" : "top_bottom";
  return "";
}

// StreamInfo::rotation. Warns about a transformation that is not supported.
int rotationOf(const AVStream& stream) noexcept {
  const auto* const m =
      reinterpret_cast<const std::int32_t*>(besideStream(stream, AV_PKT_DATA_DISPLAYMATRIX, 9 * sizeof(std::int32_t)));
  if (m == nullptr) return 0;
  const double degrees = -av_display_rotation_get(m);  // clockwise; NaN for an invalid matrix
  const bool mirrored = static_cast<double>(m[0]) * m[4] < static_cast<double>(m[1]) * m[3];
  const double quarters = std::round(degrees / 90);
  if (!mirrored && std::abs(degrees - 90 * quarters) < 1) return (static_cast<int>(quarters) + 4) % 4;
  log(LogLevel::Warning, "media",
      "track %d is to be shown %s, which is not supported; convert the film to upright pictures", stream.index,
      mirrored ? "mirrored" : "turned by other than a multiple of 90 degrees");
  return 0;
}

// The chosen programme's; nullopt if its pictures and sound have no times yet.
std::optional<Duration> startOfProgramme(const AVFormatContext& context) noexcept {
  std::optional<Duration> start;
  for (const AVStream* const stream : std::span(context.streams, context.nb_streams)) {
    if (stream->start_time == AV_NOPTS_VALUE) continue;
    if (const auto kind = kindOf(*stream); kind != StreamKind::Video && kind != StreamKind::Audio) continue;
    const Duration own = durationFrom(stream->start_time, stream->time_base);
    start = std::min(start.value_or(own), own);
  }
  return start;
}

// Picture size, then bit rate, of a programme's best video.
std::pair<std::int64_t, std::int64_t> worthOf(const AVFormatContext& context, const AVProgram& programme) noexcept {
  std::int64_t area = 0;
  for (unsigned i = 0; i < programme.nb_stream_indexes; ++i) {
    const AVCodecParameters& parameters = *context.streams[programme.stream_index[i]]->codecpar;
    area = std::max(area, std::int64_t{parameters.width} * parameters.height);
  }
  const AVDictionaryEntry* const rate = av_dict_get(programme.metadata, "variant_bitrate", nullptr, 0);
  return {area, rate == nullptr ? 0 : std::strtoll(rate->value, nullptr, 10)};
}

void becomeGray16(AVCodecParameters& parameters, AVPixelFormat format) noexcept {
  parameters.codec_id = AV_CODEC_ID_RAWVIDEO;
  parameters.codec_tag = 0;  // it would override the format
  parameters.format = format;
  parameters.bits_per_coded_sample = 16;
}

// The recorder writes infrared in the same format.
bool isKinectDepth(const StreamInfo& info) {
  const auto title = info.tags.find("TITLE");
  return info.tags.contains("K4A_DEPTH_TRACK") || (title != info.tags.end() && title->second == "DEPTH");
}

}  // namespace

std::map<std::string, std::string> tagsOf(const AVDictionary* dictionary) {
  std::map<std::string, std::string> tags;
  const AVDictionaryEntry* entry = nullptr;
  while ((entry = av_dict_get(dictionary, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr) {
    std::string key = entry->key;
    std::transform(key.begin(), key.end(), key.begin(), [](unsigned char c) { return std::toupper(c); });
    tags[key] = entry->value;
  }
  return tags;
}

std::vector<Chapter> chaptersOf(const AVFormatContext& context, Duration start) {
  std::vector<Chapter> chapters;
  for (unsigned i = 0; i < context.nb_chapters; ++i) {
    const AVChapter& chapter = *context.chapters[i];
    const AVDictionaryEntry* const title = av_dict_get(chapter.metadata, "title", nullptr, 0);
    chapters.push_back({.begin = durationFrom(chapter.start, chapter.time_base) - start,
                        .end = durationFrom(chapter.end, chapter.time_base) - start,
                        .title = title == nullptr ? "" : title->value});
  }
  return chapters;
}

StreamKind kindOf(const AVStream& stream) noexcept {
  if (stream.discard == AVDISCARD_ALL) return StreamKind::Other;
  constexpr int kStills = AV_DISPOSITION_ATTACHED_PIC | AV_DISPOSITION_TIMED_THUMBNAILS;
  switch (stream.codecpar->codec_type) {
    case AVMEDIA_TYPE_VIDEO:
      return (stream.disposition & kStills) == 0 ? StreamKind::Video : StreamKind::Other;
    case AVMEDIA_TYPE_AUDIO:
      return StreamKind::Audio;
    case AVMEDIA_TYPE_SUBTITLE:
      return StreamKind::Subtitle;
    default:
      return StreamKind::Other;
  }
}

bool isTextArt(const AVFormatContext& context) noexcept {
  if (context.nb_streams != 1) return false;
  switch (context.streams[0]->codecpar->codec_id) {
    case AV_CODEC_ID_ANSI:
    case AV_CODEC_ID_BINTEXT:
    case AV_CODEC_ID_XBIN:
    case AV_CODEC_ID_IDF:
      return true;
    default:
      return false;
  }
}

bool isTimed(const AVFormatContext& context) noexcept {
  if ((context.iformat->flags & AVFMT_NOTIMESTAMPS) != 0) return false;
  return context.iformat->priv_class == nullptr ||
         av_opt_find(context.priv_data, "framerate", nullptr, 0, 0) == nullptr;
}

Duration startOf(const AVFormatContext& context) noexcept {
  if (const auto start = startOfProgramme(context); start && context.nb_programs > 1) return *start;
  if (context.start_time == AV_NOPTS_VALUE) return Duration(0);
  const Duration start = durationFrom(context.start_time, kMicrosecond);
  for (const AVStream* const stream : std::span(context.streams, context.nb_streams)) {
    if (stream->start_time == AV_NOPTS_VALUE) continue;
    const Duration exact = durationFrom(stream->start_time, stream->time_base);
    if (std::chrono::abs(exact - start) <= std::chrono::microseconds(1)) return exact;
  }
  return start;
}

Duration lengthOf(const AVFormatContext& context, Duration start) noexcept {
  if (context.duration <= 0) return Duration(0);
  const std::string_view name(context.iformat->name);
  if (name == "asf") return longestStreamOf(context);
  const Duration stated = durationFrom(context.duration, kMicrosecond);
  if (context.duration_estimation_method != AVFMT_DURATION_FROM_STREAM || start <= Duration(0)) return stated;
  Duration end{0};
  for (unsigned i = 0; i < context.nb_streams; ++i) {
    const AVStream& stream = *context.streams[i];
    if (stream.start_time == AV_NOPTS_VALUE || stream.duration <= 0) continue;
    end = std::max(end, durationFrom(stream.start_time + stream.duration, stream.time_base));
  }
  if (end > start) return std::min(stated, end - start);
  const Duration more = name.starts_with("matroska") ? start : name == "flv" ? decodingDelayOf(context) : Duration(0);
  return stated > more ? stated - more : stated;
}

int earliestStream(const AVFormatContext& context, int leading) noexcept {
  int earliest = leading;
  const auto begins = [&](int i) {
    const AVStream& stream = *context.streams[i];
    return stream.start_time == AV_NOPTS_VALUE ? Duration::max() : durationFrom(stream.start_time, stream.time_base);
  };
  for (int i = 0; i < static_cast<int>(context.nb_streams); ++i) {
    if (kindOf(*context.streams[i]) == StreamKind::Video && begins(i) < begins(earliest)) earliest = i;
  }
  return earliest;
}

void chooseProgramme(AVFormatContext& context) noexcept {
  if (context.nb_programs < 2) return;
  AVProgram** const end = context.programs + context.nb_programs;
  const AVProgram& best = **std::max_element(context.programs, end, [&](const AVProgram* a, const AVProgram* b) {
    return worthOf(context, *a) < worthOf(context, *b);
  });
  for (unsigned i = 0; i < context.nb_streams; ++i) context.streams[i]->discard = AVDISCARD_ALL;
  for (unsigned i = 0; i < best.nb_stream_indexes; ++i) {
    context.streams[best.stream_index[i]]->discard = AVDISCARD_DEFAULT;
  }
}

Result<StreamInfo> describeStream(const AVStream& stream, bool timed, bool photo) {
  const AVCodecParameters& parameters = *stream.codecpar;
  StreamInfo info;
  info.index = stream.index;
  info.kind = kindOf(stream);
  if (parameters.extradata_size > 0) {
    info.extradata.assign(parameters.extradata, parameters.extradata + parameters.extradata_size);
  }
  info.width = parameters.width;
  info.height = parameters.height;
  if (info.kind == StreamKind::Video) describeSignals(info, parameters, stream.sample_aspect_ratio);
  if (info.kind == StreamKind::Video) info.rotation = rotationOf(stream);
  info.sample_rate_hz = parameters.sample_rate;
  info.channels = parameters.ch_layout.nb_channels;
  info.channel_layout = layoutOf(parameters.ch_layout);
  info.frame_period = framePeriodOf(stream);
  info.counted = !timed;
  if (timed) info.average_rate = {stream.avg_frame_rate.num, stream.avg_frame_rate.den};
  if (timed) info.base_rate = {stream.r_frame_rate.num, stream.r_frame_rate.den};
  if (timed && stream.duration > 0) info.duration = durationFrom(stream.duration, stream.time_base);
  info.tags = tagsOf(stream.metadata);
  if (const std::string mode = stereoModeOf(stream); !mode.empty()) info.tags.insert({"STEREO_MODE", mode});
  if (parameters.codec_tag == kGray16Big && isKinectDepth(info)) {
    info.tags.insert({{"DEPTH_UNIT", "1"}, {"DEPTH_INVALID", "0"}});
  }
  info.by_default = (stream.disposition & AV_DISPOSITION_DEFAULT) != 0;
  info.forced = (stream.disposition & AV_DISPOSITION_FORCED) != 0;
  info.auxiliary = info.kind == StreamKind::Video && parameters.codec_tag == kAuxiliaryVideo;

  auto native = std::make_unique<NativeStream>(NativeStream{.parameters = {}, .photo = photo});
  native->parameters.reset(avcodec_parameters_alloc());
  if (!native->parameters || avcodec_parameters_copy(native->parameters.get(), &parameters) < 0) {
    return std::unexpected(openError(AVERROR(ENOMEM)));
  }
  if (parameters.codec_tag == kGray16Big) becomeGray16(*native->parameters, AV_PIX_FMT_GRAY16BE);
  if (parameters.codec_tag == kGray16Little) becomeGray16(*native->parameters, AV_PIX_FMT_GRAY16LE);
  info.codec = avcodec_get_name(native->parameters->codec_id);
  native->time_base = stream.time_base;
  native->sample_aspect = stream.sample_aspect_ratio;
  info.native = std::shared_ptr<NativeStream>(native.release(), NativeStreamDeleter{});
  return info;
}

}  // namespace relievo::ffmpeg
