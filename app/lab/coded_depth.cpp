// SPDX-License-Identifier: Apache-2.0
// libx264 and libavcodec's own decoder, back to back. Pictures are numbered through the coder; their times stay here.
#include "app/lab/coded_depth.h"

#include <algorithm>
#include <cerrno>
#include <memory>
#include <utility>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
}

namespace relievo {
namespace {

constexpr const char* kNoMemory = "out of memory in the coder of depth";

struct Free {
  void operator()(AVCodecContext* context) const noexcept { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const noexcept { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const noexcept { av_packet_free(&packet); }
};
using CodecContext = std::unique_ptr<AVCodecContext, Free>;
using Picture = std::unique_ptr<AVFrame, Free>;

Result<void> check(std::span<const Frame> frames) {
  if (frames.empty()) return fail(ErrorCode::InvalidArgument, "no frames to code");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& f = frames[i];
    if (f.empty() || f.model != ColorModel::Gray || f.components[0].step_bytes != 1 || f.width != frames[0].width ||
        f.height != frames[0].height) {
      return fail(ErrorCode::InvalidArgument, "depth to code is 8-bit gray frames of one size");
    }
    if (i > 0 && f.pts <= frames[i - 1].pts) {
      return fail(ErrorCode::InvalidArgument, "the times of frames to code must rise");
    }
  }
  return {};
}

Result<CodecContext> openEncoder(std::span<const Frame> frames, int crf) {
  const AVCodec* const encoder = avcodec_find_encoder_by_name("libx264");
  if (encoder == nullptr) {
    return fail(ErrorCode::Unsupported, "FFmpeg on this machine has no libx264; install one that has");
  }
  CodecContext context(avcodec_alloc_context3(encoder));
  if (!context) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
  // One tick of the coder's clock is one frame; quality by crf depends on the frame rate a little.
  const Duration whole = frames.back().pts - frames.front().pts;
  const Duration period = frames.size() > 1 ? whole / (frames.size() - 1) : std::chrono::milliseconds(40);
  av_reduce(&context->time_base.num, &context->time_base.den, period.count(), 1'000'000'000, 1'000'000);
  context->framerate = av_inv_q(context->time_base);
  context->width = frames[0].width;
  context->height = frames[0].height;
  context->pix_fmt = AV_PIX_FMT_GRAY8;
  context->color_range = AVCOL_RANGE_JPEG;   // unsaid, readers would take the codes for limited range
  context->log_level_offset = AV_LOG_TRACE;  // libx264 would write its statistics to stderr
  av_opt_set_double(context->priv_data, "crf", crf, 0);
  if (avcodec_open2(context.get(), encoder, nullptr) < 0) {
    return fail(ErrorCode::InvalidArgument, "libx264 refuses frames of this size or this crf; choose others");
  }
  return context;
}

Result<CodecContext> openDecoder() {
  const AVCodec* const decoder = avcodec_find_decoder(AV_CODEC_ID_H264);
  CodecContext context(decoder == nullptr ? nullptr : avcodec_alloc_context3(decoder));
  if (!context || avcodec_open2(context.get(), decoder, nullptr) < 0) {
    return fail(ErrorCode::Unsupported, "FFmpeg on this machine has no H.264 decoder; install one that has");
  }
  return context;
}

// 4:0:0 comes out as 4:2:0 with flat chroma: only the first plane means anything.
Frame frameOf(Picture picture, const Frame& original) {
  Frame frame;
  frame.pts = original.pts;
  frame.duration = original.duration;
  frame.width = picture->width;
  frame.height = picture->height;
  frame.model = ColorModel::Gray;
  frame.range = picture->color_range == AVCOL_RANGE_JPEG ? ColorRange::Full : ColorRange::Unspecified;
  frame.sample_aspect = original.sample_aspect;
  frame.plane_count = 1;
  frame.planes[0] = {picture->data[0], picture->linesize[0]};
  frame.owner = std::shared_ptr<AVFrame>(std::move(picture));
  return frame;
}

class RoundTrip {
 public:
  RoundTrip(std::span<const Frame> originals, CodecContext encoder, CodecContext decoder)
      : originals_(originals),
        encoder_(std::move(encoder)),
        decoder_(std::move(decoder)),
        input_(av_frame_alloc()),
        packet_(av_packet_alloc()) {}

  Result<CodedDepth> run() {
    if (!input_ || !packet_) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    for (std::size_t i = 0; i < originals_.size(); ++i) {
      if (!sendOriginal(i) || !movePackets()) return failed();
    }
    if (avcodec_send_frame(encoder_.get(), nullptr) < 0 || !movePackets()) return failed();
    if (avcodec_send_packet(decoder_.get(), nullptr) < 0 || !collectPictures()) return failed();
    if (coded_.frames.size() != originals_.size()) return failed();
    return std::move(coded_);
  }

 private:
  static Result<CodedDepth> failed() { return fail(ErrorCode::Io, "coding depth in memory failed"); }

  bool sendOriginal(std::size_t index) {
    const Frame& original = originals_[index];
    input_->format = encoder_->pix_fmt;
    input_->width = original.width;
    input_->height = original.height;
    input_->color_range = encoder_->color_range;
    input_->pts = static_cast<std::int64_t>(index);
    input_->data[0] = const_cast<std::uint8_t*>(original.planes[0].data);  // the encoder copies, it does not write
    input_->linesize[0] = static_cast<int>(original.planes[0].stride_bytes);
    return avcodec_send_frame(encoder_.get(), input_.get()) >= 0;
  }

  bool movePackets() {
    for (;;) {
      const int got = avcodec_receive_packet(encoder_.get(), packet_.get());
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return true;
      if (got < 0) return false;
      coded_.bytes += static_cast<std::uint64_t>(packet_->size);
      const int sent = avcodec_send_packet(decoder_.get(), packet_.get());
      av_packet_unref(packet_.get());
      if (sent < 0 || !collectPictures()) return false;
    }
  }

  bool collectPictures() {
    for (;;) {
      Picture picture(av_frame_alloc());
      if (!picture) return false;
      const int got = avcodec_receive_frame(decoder_.get(), picture.get());
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return true;
      const std::size_t index = coded_.frames.size();
      if (got < 0 || picture->pts != static_cast<std::int64_t>(index)) return false;
      coded_.frames.push_back(frameOf(std::move(picture), originals_[index]));
    }
  }

  std::span<const Frame> originals_;
  CodecContext encoder_, decoder_;
  Picture input_;
  std::unique_ptr<AVPacket, Free> packet_;
  CodedDepth coded_;
};

}  // namespace

Result<CodedDepth> codeDepth(std::span<const Frame> frames, int crf) {
  if (const auto checked = check(frames); !checked) return std::unexpected(checked.error());
  auto encoder = openEncoder(frames, crf);
  if (!encoder) return std::unexpected(encoder.error());
  auto decoder = openDecoder();
  if (!decoder) return std::unexpected(decoder.error());
  return RoundTrip(frames, std::move(*encoder), std::move(*decoder)).run();
}

}  // namespace relievo
