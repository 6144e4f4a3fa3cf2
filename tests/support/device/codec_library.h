// SPDX-License-Identifier: Apache-2.0
// The decoding behind the simulated hardware decoder: FFmpeg's, which gives its pictures in order.
#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <cstring>
#include <deque>
#include <stdexcept>

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace relievo::test {

struct CodecLibrary {
  AVCodecContext* context = nullptr;
  std::deque<AVFrame*> pictures;

  explicit CodecLibrary(std::uint32_t fourcc) {
    const AVCodec* const codec =
        avcodec_find_decoder(fourcc == V4L2_PIX_FMT_HEVC ? AV_CODEC_ID_HEVC : AV_CODEC_ID_H264);
    context = avcodec_alloc_context3(codec);
    context->thread_count = 1;
    if (avcodec_open2(context, codec, nullptr) < 0) throw std::runtime_error("FFmpeg has no decoder");
  }
  ~CodecLibrary() {
    forget();
    avcodec_free_context(&context);
  }
  CodecLibrary(const CodecLibrary&) = delete;
  CodecLibrary& operator=(const CodecLibrary&) = delete;

  bool feed(const std::uint8_t* data, std::uint32_t bytes, std::uint64_t tag) {
    AVPacket* packet = av_packet_alloc();
    av_new_packet(packet, static_cast<int>(bytes));
    std::memcpy(packet->data, data, bytes);
    packet->pts = static_cast<std::int64_t>(tag);
    const bool good = avcodec_send_packet(context, packet) >= 0;
    av_packet_free(&packet);
    receive();
    return good;
  }
  void receive() {
    for (;;) {
      AVFrame* picture = av_frame_alloc();
      if (avcodec_receive_frame(context, picture) < 0) return av_frame_free(&picture);
      pictures.push_back(picture);
    }
  }
  void drain() {
    avcodec_send_packet(context, nullptr);
    receive();
    avcodec_flush_buffers(context);
  }
  void pop() {
    av_frame_free(&pictures.front());
    pictures.pop_front();
  }
  void forget() {
    while (!pictures.empty()) pop();
    avcodec_flush_buffers(context);
  }
};

}  // namespace relievo::test
