// SPDX-License-Identifier: Apache-2.0
// Sound on its way into a clip.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "tests/support/film/clip_encoder.h"

extern "C" {
#include <libavutil/channel_layout.h>
}

namespace relievo::test {
namespace {

constexpr int kFramesOfAnyCodec = 1024;

double tone(double seconds, int /*channel*/) {
  return 0.5 * std::sin(2 * std::numbers::pi * 440 * seconds);
}

AVSampleFormat firstFormat(const AVCodec& codec) {
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(61, 13, 100)  // FFmpeg 7.1
  const void* formats = nullptr;
  check(avcodec_get_supported_config(nullptr, &codec, AV_CODEC_CONFIG_SAMPLE_FORMAT, 0, &formats, nullptr), codec.name);
  return *static_cast<const AVSampleFormat*>(formats);
#else
  return codec.sample_fmts[0];
#endif
}

class SoundEncoder final : public Encoder {
 public:
  SoundEncoder(AVFormatContext& file, const ClipSound& sound) : file_(file), sound_(sound) {
    const AVCodec* const codec = avcodec_find_encoder_by_name(sound.codec.c_str());
    if (codec == nullptr) give_up("no encoder " + sound.codec);
    context_.reset(avcodec_alloc_context3(codec));
    context_->sample_fmt = firstFormat(*codec);
    context_->sample_rate = sound.rate_hz;
    av_channel_layout_default(&context_->ch_layout, sound.channels);
    context_->time_base = {1, sound.rate_hz};
    context_->bit_rate = 192'000;
    context_->strict_std_compliance = FF_COMPLIANCE_EXPERIMENTAL;
    if ((file.oformat->flags & AVFMT_GLOBALHEADER) != 0) context_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    check(avcodec_open2(context_.get(), codec, nullptr), "encoder " + sound.codec);
    stream_ = avformat_new_stream(&file, nullptr);
    stream_->time_base = context_->time_base;
    check(avcodec_parameters_from_context(stream_->codecpar, context_.get()), "parameters");
    packet_.reset(av_packet_alloc());
    next_ = indexAt(sound.start);
    end_ = indexAt(sound.start + sound.length);
  }

  [[nodiscard]] bool done() const override { return next_ >= end_; }
  [[nodiscard]] Duration nextTime() const override { return fromSeconds(static_cast<double>(next_) / sound_.rate_hz); }

  void encodeNext() override {
    const int whole = context_->frame_size > 0 ? context_->frame_size : kFramesOfAnyCodec;
    Owned<AVFrame> frame(av_frame_alloc());
    frame->format = context_->sample_fmt;
    frame->sample_rate = sound_.rate_hz;
    frame->nb_samples = static_cast<int>(std::min<std::int64_t>(whole, end_ - next_));
    check(av_channel_layout_copy(&frame->ch_layout, &context_->ch_layout), "layout");
    frame->pts = next_;
    check(av_frame_get_buffer(frame.get(), 0), "samples");
    fill(*frame);
    next_ += frame->nb_samples;
    check(avcodec_send_frame(context_.get(), frame.get()), "encode");
    write();
  }

  void finish() override {
    check(avcodec_send_frame(context_.get(), nullptr), "flush");
    write();
  }

 private:
  [[nodiscard]] std::int64_t indexAt(Duration time) const { return std::llround(toSeconds(time) * sound_.rate_hz); }

  void fill(AVFrame& frame) const {
    const bool planar = av_sample_fmt_is_planar(context_->sample_fmt) != 0;
    for (int channel = 0; channel < sound_.channels; ++channel) {
      for (int i = 0; i < frame.nb_samples; ++i) {
        const double seconds = static_cast<double>(frame.pts + i) / sound_.rate_hz;
        const double value = sound_.sound ? sound_.sound(seconds, channel) : tone(seconds, channel);
        put(frame.extended_data[planar ? channel : 0], planar ? i : i * sound_.channels + channel, value);
      }
    }
  }

  void put(std::uint8_t* data, int index, double value) const {
    switch (av_get_packed_sample_fmt(context_->sample_fmt)) {
      case AV_SAMPLE_FMT_FLT:
        reinterpret_cast<float*>(data)[index] = static_cast<float>(value);
        return;
      case AV_SAMPLE_FMT_S16:
        reinterpret_cast<std::int16_t*>(data)[index] = static_cast<std::int16_t>(std::lround(32767 * value));
        return;
      case AV_SAMPLE_FMT_S32:
        reinterpret_cast<std::int32_t*>(data)[index] = static_cast<std::int32_t>(std::llround(2147483647.0 * value));
        return;
      default:
        give_up("no samples for " + sound_.codec);
    }
  }

  void write() {
    while (avcodec_receive_packet(context_.get(), packet_.get()) >= 0) {
      av_packet_rescale_ts(packet_.get(), context_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      check(av_interleaved_write_frame(&file_, packet_.get()), "write");
    }
  }

  AVFormatContext& file_;
  ClipSound sound_;
  Owned<AVCodecContext> context_;
  AVStream* stream_ = nullptr;
  Owned<AVPacket> packet_;
  std::int64_t next_ = 0, end_ = 0;  // frames
};

}  // namespace

std::unique_ptr<Encoder> makeSoundEncoder(AVFormatContext& file, const ClipSound& sound) {
  return std::make_unique<SoundEncoder>(file, sound);
}

}  // namespace relievo::test
