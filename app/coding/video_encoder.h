// SPDX-License-Identifier: Apache-2.0
// Encodes the pictures of one video track: libx264, libx265 or FFV1 through libavcodec.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
}

#include "app/coding/video_codec.h"
#include "hal/media/frame.h"
#include "hal/media/media_time.h"
#include "platform/error.h"

namespace relievo {

// The OS error number inside an FFmpeg error code; 0 if it is FFmpeg's own.
[[nodiscard]] int osErrorOf(int code) noexcept;

// Key frames are exactly where the caller asks for them (FFV1: everywhere). Use from one thread; the libraries have
// threads of their own.
class VideoEncoder {
 public:
  struct Settings {
    VideoCodec codec = VideoCodec::H264;
    int width = 0, height = 0;
    int bits = 8;
    bool gray = false;  // 4:0:0, else 4:2:0
    // tune for accurate values instead of appearance: psycho-visual tricks would shift the surface
    bool to_touch = false;
    // H.264 in half the time and with a short look-ahead, so that few pictures are in memory. A depth of the same error
    // takes half more bytes. The same stream whatever the machine's number of cores.
    bool quick = false;
    bool live = false;  // no B-frames and no look-ahead
    ColorRange range = ColorRange::Unspecified;
    ColorMatrix matrix = ColorMatrix::Unspecified;
    std::uint8_t primaries = kUnspecifiedColor, transfer = kUnspecifiedColor;  // codes of ITU-T H.273, as in a Frame
    double sample_aspect = 1.0;
    Duration frame_period{0};  // for the rate control only; 0: unknown
    int crf = 18;              // 0: lossless, as FFV1 always is
    std::string stream_tags;   // lines KEY=VALUE stored with each key frame (hal/media/stream_tags.h); not for FFV1
  };
  // MPEG's clock: exact for 24, 25, 30, 50, 60 and for 30000/1001 frames a second.
  static constexpr AVRational kTimeBase{1, 90000};
  // No gaps between rows; more than 8 bits are two bytes, little endian. Gray uses the first plane only.
  using Planes = std::array<const std::uint8_t*, 3>;
  // Receives packets with times in kTimeBase; whatever it leaves in the packet is freed afterwards.
  using Sink = std::function<Result<void>(AVPacket&)>;

  // Unsupported if FFmpeg lacks the library; InvalidArgument for bits, a size (4:2:0 needs even ones) or a quality that
  // the codec does not support. `global_header`: store parameter sets in the container instead of the stream. From then
  // on FFmpeg may allocate large blocks in the whole process, whatever bounded it before.
  [[nodiscard]] Result<void> open(const Settings& settings, bool global_header);
  [[nodiscard]] const AVCodecContext& context() const noexcept { return *codec_; }
  // Corrupt if the timestamps do not increase.
  [[nodiscard]] Result<void> encode(const Planes& planes, MediaTime time, bool key, const Sink& sink);
  [[nodiscard]] Result<void> drain(const Sink& sink);

 private:
  struct Free {
    void operator()(AVCodecContext* context) const noexcept { avcodec_free_context(&context); }
    void operator()(AVFrame* frame) const noexcept { av_frame_free(&frame); }
    void operator()(AVPacket* packet) const noexcept { av_packet_free(&packet); }
  };
  [[nodiscard]] bool attachTags();
  [[nodiscard]] Result<void> handOut(const Sink& sink);

  std::unique_ptr<AVCodecContext, Free> codec_;
  std::unique_ptr<AVFrame, Free> frame_;
  std::unique_ptr<AVPacket, Free> packet_;
  std::string stream_tags_;
  std::int64_t last_pts_ = AV_NOPTS_VALUE;
};

}  // namespace relievo
