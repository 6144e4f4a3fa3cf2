// SPDX-License-Identifier: Apache-2.0
// Configures the encoders, sends pictures and receives packets.
#include "app/coding/video_encoder.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "hal/media/stream_tags.h"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

namespace relievo {
namespace {

constexpr AVRational kNanosecond{1, 1'000'000'000};

struct Codec {
  const char* name;
  const char* encoder;  // FFmpeg's name
  std::initializer_list<int> bits;
  const char* missing;
  const char* refusal;
};
constexpr std::array<Codec, 3> kCodecs{{
    {"H.264",
     "libx264",
     {8, 10},
     "this FFmpeg has no libx264 encoder; install one that does",
     "libx264 rejects this picture size or quality; choose another"},
    {"HEVC",
     "libx265",
     {8, 10, 12},
     "this FFmpeg has no libx265 encoder; install one that does",
     "libx265 rejects this picture size or quality; choose another"},
    {"FFV1",
     "ffv1",
     {8, 10, 12, 16},
     "this FFmpeg has no FFV1 encoder; install one that does",
     "FFV1 rejects this picture size; choose another"},
}};
const Codec& of(VideoCodec codec) {
  return kCodecs.at(static_cast<std::size_t>(codec));
}

AVPixelFormat pixelFormat(const VideoEncoder::Settings& s) {
  switch (s.bits) {
    case 8:
      return s.gray ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_YUV420P;
    case 10:
      return s.gray ? AV_PIX_FMT_GRAY10LE : AV_PIX_FMT_YUV420P10LE;
    case 12:
      return s.gray ? AV_PIX_FMT_GRAY12LE : AV_PIX_FMT_YUV420P12LE;
    default:
      return s.gray ? AV_PIX_FMT_GRAY16LE : AV_PIX_FMT_YUV420P16LE;
  }
}

AVColorRange rangeOf(ColorRange range) {
  switch (range) {
    case ColorRange::Full:
      return AVCOL_RANGE_JPEG;
    case ColorRange::Limited:
      return AVCOL_RANGE_MPEG;
    case ColorRange::Unspecified:
      break;
  }
  return AVCOL_RANGE_UNSPECIFIED;
}

void signalMatrix(AVCodecContext& codec, ColorMatrix matrix) {
  switch (matrix) {
    case ColorMatrix::Bt601:
      codec.colorspace = AVCOL_SPC_SMPTE170M;
      break;
    case ColorMatrix::Bt709:
      codec.colorspace = AVCOL_SPC_BT709;
      break;
    case ColorMatrix::Bt2020:
      codec.colorspace = AVCOL_SPC_BT2020_NCL;
      break;
    case ColorMatrix::Unspecified:
      break;
  }
}

void set(AVCodecContext& codec, const char* key, const std::string& value) {
  av_opt_set(codec.priv_data, key, value.c_str(), 0);
}

// Slices are encoded in parallel without buffering more pictures; their number affects the stream, so it is fixed.
constexpr const char* kQuick = ":sliced-threads=1:threads=4:ref=1:bframes=2:b-pyramid=none:weightp=0";
// Depth compresses better with the careful search of "medium"; for colour it costs more than it gains.
constexpr const char* kQuickDepth = ":rc-lookahead=4:trellis=0:subme=6:partitions=i8x8,i4x4";
constexpr const char* kQuickColor = ":rc-lookahead=3:trellis=1";
// The crf at which the quick preset makes depth as exact as "medium" does at the given crf, and colour nearly so.
double quickQuality(const VideoEncoder::Settings& s) {
  return std::max(s.crf - (s.to_touch ? 3.0 : 2.0), 0.5 * s.crf);
}

void configureH264(AVCodecContext& codec, const VideoEncoder::Settings& s) {
  // libx264 derives its level from the frame rate, which it takes from the time base unless set.
  std::string parameters = "fps=" + std::to_string(codec.framerate.num) + "/" + std::to_string(codec.framerate.den) +
                           ":scenecut=0:keyint=infinite";
  // Psycho-visual decisions distort edges: without them the largest error is 11 codes instead of 52 at the same size.
  if (s.to_touch) parameters += ":no-psy=1:aq-mode=0";
  if (s.crf == 0) parameters += ":qp=0";  // crf 0 is lossless only at 8 bits
  const bool quick = s.quick && !s.live;
  if (quick) parameters.append(kQuick).append(s.to_touch ? kQuickDepth : kQuickColor);
  set(codec, "preset", s.live || (quick && !s.to_touch) ? "veryfast" : "medium");
  set(codec, "x264-params", parameters);
}

void configureHevc(AVCodecContext& codec, const VideoEncoder::Settings& s) {
  std::string parameters = "log-level=none:info=0:scenecut=0:open-gop=0";
  if (s.to_touch) parameters += ":psy-rd=0:psy-rdoq=0:aq-mode=0";
  if (s.range == ColorRange::Full) parameters += ":range=full";
  if (s.crf == 0) parameters += ":lossless=1";
  set(codec, "preset", s.live ? "ultrafast" : "fast");
  set(codec, "x265-params", parameters);
}

void configure(AVCodecContext& codec, const VideoEncoder::Settings& s, bool global_header) {
  codec.width = s.width;
  codec.height = s.height;
  codec.pix_fmt = pixelFormat(s);
  codec.time_base = VideoEncoder::kTimeBase;
  const Duration period = s.frame_period > Duration(0) ? s.frame_period : std::chrono::milliseconds(40);
  av_reduce(&codec.framerate.num, &codec.framerate.den, 1'000'000'000, period.count(), 1'000'000);
  codec.sample_aspect_ratio = av_d2q(s.sample_aspect, 10000);
  codec.color_range = rangeOf(s.range);  // unspecified, it would be read as limited
  signalMatrix(codec, s.matrix);
  codec.color_primaries = static_cast<AVColorPrimaries>(s.primaries);
  codec.color_trc = static_cast<AVColorTransferCharacteristic>(s.transfer);
  codec.log_level_offset = AV_LOG_TRACE;  // libx264 would print its statistics to stderr
  if (global_header) codec.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (s.codec == VideoCodec::Ffv1) {
    codec.level = 3;
    codec.gop_size = 1;
    codec.slices = codec.thread_count = 4;
    return;
  }
  codec.gop_size = 1 << 20;  // `encode` places the key frames
  if (s.codec == VideoCodec::H264) configureH264(codec, s);
  else configureHevc(codec, s);
  const bool shifted = s.quick && !s.live && s.codec == VideoCodec::H264;
  if (s.crf > 0) av_opt_set_double(codec.priv_data, "crf", shifted ? quickQuality(s) : s.crf, 0);
  if (s.live) set(codec, "tune", "zerolatency");
  av_opt_set_int(codec.priv_data, "forced-idr", 1, 0);
  av_opt_set_int(codec.priv_data, "udu_sei", 1, 0);
}

}  // namespace

int osErrorOf(int code) noexcept {
  const int number = AVUNERROR(code);
  return number > 0 && number < 4096 ? number : 0;  // FFmpeg's own codes are far larger
}

const char* name(VideoCodec codec) noexcept {
  return of(codec).name;
}

bool codes(VideoCodec codec, int bits) noexcept {
  return std::find(of(codec).bits.begin(), of(codec).bits.end(), bits) != of(codec).bits.end();
}

Result<void> VideoEncoder::open(const Settings& settings, bool global_header) {
  const AVCodec* const encoder = avcodec_find_encoder_by_name(of(settings.codec).encoder);
  if (encoder == nullptr) return fail(ErrorCode::Unsupported, of(settings.codec).missing);
  if (!codes(settings.codec, settings.bits)) {
    return fail(ErrorCode::InvalidArgument,
                "the codec does not support this bit depth; H.264 has 8 and 10, HEVC also 12");
  }
  if (!settings.gray && (settings.width % 2 != 0 || settings.height % 2 != 0)) {
    return fail(ErrorCode::InvalidArgument, "4:2:0 needs an even width and height; crop the pictures");
  }
  codec_.reset(avcodec_alloc_context3(encoder));
  frame_.reset(av_frame_alloc());
  packet_.reset(av_packet_alloc());
  if (!codec_ || !frame_ || !packet_) return fail(ErrorCode::Exhausted, "out of memory for an encoder", ENOMEM);
  last_pts_ = AV_NOPTS_VALUE;
  stream_tags_ = settings.stream_tags;
  configure(*codec_, settings, global_header);
  // Ends a bound that a program has set for its inputs: a packet of FFV1 takes 148 bytes a sample, and the index of a
  // film that is written 144 a picture.
  av_max_alloc(std::numeric_limits<int>::max());
  if (const int code = avcodec_open2(codec_.get(), encoder, nullptr); code < 0) {
    return fail(ErrorCode::InvalidArgument, of(settings.codec).refusal, osErrorOf(code));
  }
  return {};
}

Result<void> VideoEncoder::encode(const Planes& planes, MediaTime time, bool key, const Sink& sink) {
  const std::int64_t pts = av_rescale_q(time.time_since_epoch().count(), kNanosecond, kTimeBase);
  if (last_pts_ != AV_NOPTS_VALUE && pts <= last_pts_) {
    return fail(ErrorCode::Corrupt, "the timestamps of its pictures do not increase; give it a frame rate");
  }
  const bool first = last_pts_ == AV_NOPTS_VALUE;
  last_pts_ = pts;
  const AVPixFmtDescriptor& format = *av_pix_fmt_desc_get(codec_->pix_fmt);
  frame_->format = codec_->pix_fmt;
  frame_->width = codec_->width;
  frame_->height = codec_->height;
  frame_->color_range = codec_->color_range;
  frame_->pts = pts;
  frame_->pict_type = key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
  for (std::size_t i = 0; i < format.nb_components; ++i) {
    frame_->data[i] = const_cast<std::uint8_t*>(planes[i]);  // the encoder copies and does not write
    frame_->linesize[i] = (i == 0 ? codec_->width : codec_->width / 2) * format.comp[0].step;
  }
  if ((key || first) && !stream_tags_.empty() && !attachTags()) {
    return fail(ErrorCode::Exhausted, "out of memory for a picture", ENOMEM);
  }
  // With a buffer of its own a frame is handed on; without one, FFmpeg would copy it, and the encoder once more.
  frame_->buf[0] = av_buffer_create(frame_->data[0], 1, [](void*, std::uint8_t*) {}, nullptr, AV_BUFFER_FLAG_READONLY);
  const int code = avcodec_send_frame(codec_.get(), frame_.get());
  av_buffer_unref(&frame_->buf[0]);
  av_frame_remove_side_data(frame_.get(), AV_FRAME_DATA_SEI_UNREGISTERED);
  if (code < 0) return fail(ErrorCode::Io, "the encoder failed on a picture", osErrorOf(code));
  return handOut(sink);
}

bool VideoEncoder::attachTags() {
  AVFrameSideData* const data = av_frame_new_side_data(frame_.get(), AV_FRAME_DATA_SEI_UNREGISTERED,
                                                       kStreamTagsUuid.size() + stream_tags_.size());
  if (data == nullptr) return false;
  std::copy(kStreamTagsUuid.begin(), kStreamTagsUuid.end(), data->data);
  std::memcpy(data->data + kStreamTagsUuid.size(), stream_tags_.data(), stream_tags_.size());
  return true;
}

Result<void> VideoEncoder::drain(const Sink& sink) {
  if (const int code = avcodec_send_frame(codec_.get(), nullptr); code < 0) {
    return fail(ErrorCode::Io, "the encoder failed at the end", osErrorOf(code));
  }
  return handOut(sink);
}

Result<void> VideoEncoder::handOut(const Sink& sink) {
  for (;;) {
    const int code = avcodec_receive_packet(codec_.get(), packet_.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
    if (code < 0) return fail(ErrorCode::Io, "the encoder failed on a picture", osErrorOf(code));
    if (auto taken = sink(*packet_); !taken) return taken;
    av_packet_unref(packet_.get());
  }
}

}  // namespace relievo
