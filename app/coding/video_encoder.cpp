// SPDX-License-Identifier: Apache-2.0
// Settings of libx264, and packets on their way into the file.
#include "app/author/h264_track.h"

#include <cerrno>
#include <string>

extern "C" {
#include <libavutil/opt.h>
}

namespace relievo {
namespace {

// The clock of MPEG: exact for 24, 25, 30, 50, 60 and for 30000/1001 frames a second.
constexpr AVRational kTimeBase{1, 90000};
constexpr AVRational kNanosecond{1, 1'000'000'000};

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
      codec.color_primaries = AVCOL_PRI_BT709;
      codec.color_trc = AVCOL_TRC_BT709;
      break;
    case ColorMatrix::Bt2020:
      codec.colorspace = AVCOL_SPC_BT2020_NCL;
      break;
    case ColorMatrix::Unspecified:
      break;
  }
}

void configure(AVCodecContext& codec, const H264Track::Settings& s, bool global_header) {
  codec.width = s.width;
  codec.height = s.height;
  codec.pix_fmt = s.gray ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_YUV420P;
  codec.time_base = kTimeBase;
  const Duration period = s.frame_period > Duration(0) ? s.frame_period : std::chrono::milliseconds(40);
  av_reduce(&codec.framerate.num, &codec.framerate.den, 1'000'000'000, period.count(), 1'000'000);
  codec.sample_aspect_ratio = av_d2q(s.sample_aspect, 10000);
  codec.color_range = rangeOf(s.range);
  signalMatrix(codec, s.matrix);
  codec.gop_size = 1 << 20;  // key frames are where `encode` asks for them
  if (global_header) codec.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  // libx264 takes the frame rate, on which its level rests, from the time base unless told.
  const std::string parameters = "fps=" + std::to_string(codec.framerate.num) + "/" +
                                 std::to_string(codec.framerate.den) + ":scenecut=0:keyint=infinite" +
                                 s.x264_parameters;
  av_opt_set(codec.priv_data, "preset", s.preset, 0);
  av_opt_set(codec.priv_data, "x264-params", parameters.c_str(), 0);
  av_opt_set_double(codec.priv_data, "crf", s.crf, 0);
  av_opt_set_int(codec.priv_data, "forced-idr", 1, 0);
}

}  // namespace

int osErrorOf(int code) noexcept {
  const int number = AVUNERROR(code);
  return number > 0 && number < 4096 ? number : 0;  // FFmpeg's own codes are far larger
}

Result<void> H264Track::open(AVFormatContext* file, const Settings& settings) {
  const AVCodec* const encoder = avcodec_find_encoder_by_name("libx264");
  if (encoder == nullptr) {
    return fail(ErrorCode::Unsupported, "FFmpeg on this machine has no libx264; install one that has");
  }
  if (!settings.gray && (settings.width % 2 != 0 || settings.height % 2 != 0)) {
    return fail(ErrorCode::InvalidArgument, "colour of 4:2:0 has an even width and height; cut the pictures");
  }
  file_ = file;
  codec_.reset(avcodec_alloc_context3(encoder));
  frame_.reset(av_frame_alloc());
  packet_.reset(av_packet_alloc());
  stream_ = avformat_new_stream(file, nullptr);
  if (!codec_ || !frame_ || !packet_ || stream_ == nullptr) {
    return fail(ErrorCode::Exhausted, "out of memory for an encoder", ENOMEM);
  }
  configure(*codec_, settings, (file->oformat->flags & AVFMT_GLOBALHEADER) != 0);
  if (const int code = avcodec_open2(codec_.get(), encoder, nullptr); code < 0) {
    return fail(ErrorCode::InvalidArgument, "libx264 refuses pictures of this size or this quality; choose others",
                osErrorOf(code));
  }
  if (avcodec_parameters_from_context(stream_->codecpar, codec_.get()) < 0) {
    return fail(ErrorCode::Exhausted, "out of memory for a track", ENOMEM);
  }
  stream_->time_base = codec_->time_base;
  stream_->avg_frame_rate = codec_->framerate;
  stream_->sample_aspect_ratio = codec_->sample_aspect_ratio;
  return {};
}

Result<void> H264Track::encode(const Planes& planes, MediaTime time, bool key) {
  const std::int64_t pts = av_rescale_q(time.time_since_epoch().count(), kNanosecond, kTimeBase);
  if (totals_.frames > 0 && pts <= last_pts_) {
    return fail(ErrorCode::Corrupt, "the times of its pictures do not rise; give it a frame rate of its own");
  }
  last_pts_ = pts;
  if (totals_.frames == 0) totals_.first = time;
  totals_.last = time;
  ++totals_.frames;

  const bool gray = codec_->pix_fmt == AV_PIX_FMT_GRAY8;
  frame_->format = codec_->pix_fmt;
  frame_->width = codec_->width;
  frame_->height = codec_->height;
  frame_->color_range = codec_->color_range;
  frame_->pts = pts;
  frame_->pict_type = key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
  for (std::size_t i = 0; i < (gray ? 1u : 3u); ++i) {
    frame_->data[i] = const_cast<std::uint8_t*>(planes[i]);  // the encoder copies, it does not write
    frame_->linesize[i] = i == 0 ? codec_->width : codec_->width / 2;
  }
  const int code = avcodec_send_frame(codec_.get(), frame_.get());
  if (code < 0) return fail(ErrorCode::Io, "libx264 failed at a picture", osErrorOf(code));
  return writeReady();
}

Result<void> H264Track::drain() {
  if (const int code = avcodec_send_frame(codec_.get(), nullptr); code < 0) {
    return fail(ErrorCode::Io, "libx264 failed at the end", osErrorOf(code));
  }
  return writeReady();
}

Result<void> H264Track::writeReady() {
  for (;;) {
    int code = avcodec_receive_packet(codec_.get(), packet_.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
    if (code < 0) return fail(ErrorCode::Io, "libx264 failed at a picture", osErrorOf(code));
    totals_.bytes += static_cast<std::uint64_t>(packet_->size);
    packet_->stream_index = stream_->index;
    av_packet_rescale_ts(packet_.get(), kTimeBase, stream_->time_base);
    code = av_interleaved_write_frame(file_, packet_.get());
    if (code < 0) return fail(ErrorCode::Io, "it cannot be written; is the disk full?", osErrorOf(code));
  }
}

}  // namespace relievo
