// SPDX-License-Identifier: Apache-2.0
// Decodes the packets of a VideoEncoder as they come out, without a container.
#pragma once

#include <functional>
#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
}

#include "platform/error.h"

namespace relievo {

// On one thread; use from one thread. Pictures keep their order.
class PacketDecoder {
 public:
  struct Free {
    void operator()(AVCodecContext* context) const noexcept { avcodec_free_context(&context); }
    void operator()(AVFrame* frame) const noexcept { av_frame_free(&frame); }
    void operator()(AVCodecParameters* parameters) const noexcept { avcodec_parameters_free(&parameters); }
  };
  using Picture = std::unique_ptr<AVFrame, Free>;
  // False ends the decoding with a failure.
  using Sink = std::function<bool(Picture)>;

  // Unsupported if FFmpeg has no decoder for the encoder's codec.
  [[nodiscard]] Result<void> open(const AVCodecContext& encoder);
  // Null: no more packets come, and the last pictures come out.
  [[nodiscard]] Result<void> decode(const AVPacket* packet, const Sink& sink);

 private:
  std::unique_ptr<AVCodecContext, Free> codec_;
};

}  // namespace relievo
