// SPDX-License-Identifier: Apache-2.0
#include "app/coding/packet_decoder.h"

#include <utility>

namespace relievo {

Result<void> PacketDecoder::open(const AVCodecContext& encoder) {
  const std::unique_ptr<AVCodecParameters, Free> parameters(avcodec_parameters_alloc());
  const AVCodec* const decoder = avcodec_find_decoder(encoder.codec_id);
  codec_.reset(decoder == nullptr ? nullptr : avcodec_alloc_context3(decoder));
  if (codec_) codec_->thread_count = 1;
  if (!codec_ || !parameters || avcodec_parameters_from_context(parameters.get(), &encoder) < 0 ||
      avcodec_parameters_to_context(codec_.get(), parameters.get()) < 0 ||
      avcodec_open2(codec_.get(), decoder, nullptr) < 0) {
    codec_.reset();
    return fail(ErrorCode::Unsupported, "this FFmpeg has no decoder for this codec; install one that does");
  }
  return {};
}

Result<void> PacketDecoder::decode(const AVPacket* packet, const Sink& sink) {
  constexpr Error kFailed{ErrorCode::Io, 0, "what was encoded cannot be decoded"};
  if (avcodec_send_packet(codec_.get(), packet) < 0) return std::unexpected(kFailed);
  for (;;) {
    Picture picture(av_frame_alloc());
    if (!picture) return std::unexpected(kFailed);
    const int got = avcodec_receive_frame(codec_.get(), picture.get());
    if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return {};
    if (got < 0 || !sink(std::move(picture))) return std::unexpected(kFailed);
  }
}

}  // namespace relievo
