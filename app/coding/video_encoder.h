// SPDX-License-Identifier: Apache-2.0
// Codes the pictures of one video track: libx264, libx265 or FFV1 behind libavcodec.
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
#include "hal/frame.h"
#include "hal/media_time.h"
#include "platform/error.h"

namespace relievo {

// The system's number in a code of FFmpeg; 0 where the code is FFmpeg's own.
[[nodiscard]] int osErrorOf(int code) noexcept;

// Key frames are where the caller asks for them, and nowhere else (FFV1: everywhere). One thread; the libraries have
// threads of their own.
class VideoEncoder {
 public:
  struct Settings {
    VideoCodec codec = VideoCodec::H264;
    int width = 0, height = 0;
    int bits = 8;
    bool gray = false;      // 4:0:0, else 4:2:0
    bool to_touch = false;  // as true as it gets, not as pleasant: what flatters the eye moves the surface
    bool live = false;      // no picture waits for those after it
    ColorRange range = ColorRange::Unspecified;
    ColorMatrix matrix = ColorMatrix::Unspecified;
    std::uint8_t primaries = kUnspecifiedColor, transfer = kUnspecifiedColor;  // of ITU-T H.273, as in a Frame
    double sample_aspect = 1.0;
    Duration frame_period{0};  // for the rate control alone; 0 unknown
    int crf = 18;              // 0: lossless, as FFV1 always is
    std::string stream_tags;   // lines KEY=VALUE beside each key frame (hal/stream_tags.h); none in FFV1
  };
  // The clock of MPEG: exact for 24, 25, 30, 50, 60 and for 30000/1001 frames a second.
  static constexpr AVRational kTimeBase{1, 90000};
  // Without gaps between rows; more than 8 bits are two bytes, little endian. Gray has the first alone.
  using Planes = std::array<const std::uint8_t*, 3>;
  // Packets with times in kTimeBase; emptied by the caller or afterwards.
  using Sink = std::function<Result<void>(AVPacket&)>;

  // Unsupported where FFmpeg has not the library; InvalidArgument for bits, sizes (4:2:0 has even ones) or a quality
  // that the codec does not take. `global_header`: parameter sets lie in the container, not in the stream.
  [[nodiscard]] Result<void> open(const Settings& settings, bool global_header);
  [[nodiscard]] const AVCodecContext& context() const noexcept { return *codec_; }
  // Corrupt where the times do not rise.
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
