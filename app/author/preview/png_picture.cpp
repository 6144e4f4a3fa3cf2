// SPDX-License-Identifier: Apache-2.0
// Encodes a PNG with libavcodec.
#include "app/author/preview/png_picture.h"

#include <cstring>
#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace relievo {
namespace {

struct Free {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};

}  // namespace

Result<std::string> encodePng(const RgbPicture& picture) {
  const AVCodec* const encoder = avcodec_find_encoder(AV_CODEC_ID_PNG);
  if (encoder == nullptr) return fail(ErrorCode::NotFound, "this FFmpeg has no PNG encoder");
  const std::unique_ptr<AVCodecContext, Free> codec(avcodec_alloc_context3(encoder));
  const std::unique_ptr<AVFrame, Free> frame(av_frame_alloc());
  const std::unique_ptr<AVPacket, Free> packet(av_packet_alloc());
  if (!codec || !frame || !packet) return fail(ErrorCode::Exhausted, "out of memory for a PNG");
  codec->width = frame->width = picture.width;
  codec->height = frame->height = picture.height;
  codec->pix_fmt = AV_PIX_FMT_RGB24;
  frame->format = AV_PIX_FMT_RGB24;
  codec->time_base = {1, 25};
  if (avcodec_open2(codec.get(), encoder, nullptr) < 0 || av_frame_get_buffer(frame.get(), 0) < 0) {
    return fail(ErrorCode::Exhausted, "cannot encode a PNG of this size");
  }
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(picture.width);
  for (int y = 0; y < picture.height; ++y) {
    std::memcpy(frame->data[0] + static_cast<std::ptrdiff_t>(y) * frame->linesize[0],
                picture.pixels.data() + static_cast<std::size_t>(y) * picture.width, row_bytes);
  }
  if (avcodec_send_frame(codec.get(), frame.get()) < 0 || avcodec_send_frame(codec.get(), nullptr) < 0 ||
      avcodec_receive_packet(codec.get(), packet.get()) < 0) {
    return fail(ErrorCode::Io, "cannot encode the PNG");
  }
  return std::string(reinterpret_cast<const char*>(packet->data), packet->size);
}

}  // namespace relievo
