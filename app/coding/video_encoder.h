// SPDX-License-Identifier: Apache-2.0
// One H.264 track of a file that is being written: libx264 behind libavcodec, and the stream that its packets go to.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include "app/author/film_writer.h"
#include "hal/media_time.h"
#include "platform/error.h"

namespace relievo {

// The system's number in a code of FFmpeg; 0 where the code is FFmpeg's own.
[[nodiscard]] int osErrorOf(int code) noexcept;

class H264Track {
 public:
  struct Settings {
    int width = 0, height = 0;
    bool gray = false;
    ColorRange range = ColorRange::Unspecified;
    ColorMatrix matrix = ColorMatrix::Unspecified;
    double sample_aspect = 1.0;
    Duration frame_period{0};
    int crf = 18;
    const char* preset = "medium";
    const char* x264_parameters = "";
  };
  using Planes = std::array<const std::uint8_t*, 3>;

  // Adds a stream to `file`; packets go there as soon as its header is written.
  [[nodiscard]] Result<void> open(AVFormatContext* file, const Settings& settings);
  [[nodiscard]] AVStream* stream() const noexcept { return stream_; }
  // Planes without gaps; gray has one.
  [[nodiscard]] Result<void> encode(const Planes& planes, MediaTime time, bool key);
  [[nodiscard]] Result<void> drain();
  [[nodiscard]] const TrackTotals& totals() const noexcept { return totals_; }

 private:
  struct Free {
    void operator()(AVCodecContext* context) const noexcept { avcodec_free_context(&context); }
    void operator()(AVFrame* frame) const noexcept { av_frame_free(&frame); }
    void operator()(AVPacket* packet) const noexcept { av_packet_free(&packet); }
  };
  [[nodiscard]] Result<void> writeReady();

  std::unique_ptr<AVCodecContext, Free> codec_;
  std::unique_ptr<AVFrame, Free> frame_;
  std::unique_ptr<AVPacket, Free> packet_;
  AVFormatContext* file_ = nullptr;
  AVStream* stream_ = nullptr;
  TrackTotals totals_;
  std::int64_t last_pts_ = AV_NOPTS_VALUE;
};

}  // namespace relievo
