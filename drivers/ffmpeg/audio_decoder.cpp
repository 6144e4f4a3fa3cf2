// SPDX-License-Identifier: Apache-2.0
// Sound decoder: libavcodec decodes, libswresample converts rate, channel layout and sample format.
#include <algorithm>
#include <cerrno>

#include "drivers/ffmpeg/coding.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/library.h"

extern "C" {
#include <libavutil/channel_layout.h>
#include <libavutil/opt.h>
#include <libswresample/swresample.h>
}

namespace relievo {
namespace {

using namespace ffmpeg;

constexpr const char* kNoMemory = "out of memory in the sound decoder";

struct ResamplerDeleter {
  void operator()(SwrContext* context) const noexcept { swr_free(&context); }
};

class FfmpegAudioDecoder final : public AudioDecoder {
 public:
  FfmpegAudioDecoder() noexcept { silenceLibrary(); }
  [[nodiscard]] const char* name() const noexcept override { return "ffmpeg"; }

 private:
  Result<void> openDecoder(const StreamInfo& stream, const AudioFormat& format) override {
    packet_.reset(av_packet_alloc());
    sound_.reset(av_frame_alloc());
    last_.reset(av_frame_alloc());
    if (!packet_ || !sound_ || !last_) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    format_ = format;
    next_pts_ = MediaTime{};
    time_base_ = kNanosecond;
    if (const auto* described = native<NativeStream, NativeStreamDeleter>(stream.native)) {
      time_base_ = described->time_base;
      return openCodec(*described->parameters);
    }
    const ParametersPtr parameters = parametersFromWords(stream, AVMEDIA_TYPE_AUDIO);
    if (!parameters) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    return openCodec(*parameters);
  }

  Result<void> openCodec(const AVCodecParameters& parameters) {
    const AVCodec* const codec = avcodec_find_decoder(parameters.codec_id);
    if (codec == nullptr) {
      return fail(ErrorCode::Unsupported, "this FFmpeg has no decoder for its sound; convert the film");
    }
    context_.reset(avcodec_alloc_context3(codec));
    if (!context_) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    if (avcodec_parameters_to_context(context_.get(), &parameters) < 0) {
      return fail(ErrorCode::Corrupt, "the sound stream's parameters are invalid; convert the film");
    }
    context_->thread_count = 1;
    context_->pkt_timebase = kNanosecond;
    if (avcodec_open2(context_.get(), codec, nullptr) < 0) {
      return fail(ErrorCode::Corrupt, "the sound decoder rejects the stream's parameters; convert the film");
    }
    return {};
  }

  Result<AudioChunk> decodePacket(const Packet& packet) override {
    AudioChunk chunk;
    if (packet.bytes == 0) return chunk;  // FFmpeg would take it for the end
    if (!fillPacket(*packet_, packet, time_base_)) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    const int sent = avcodec_send_packet(context_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (sent == AVERROR(ENOMEM)) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    if (sent < 0) countDamaged();
    for (;;) {
      const int got = avcodec_receive_frame(context_.get(), sound_.get());
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return chunk;
      if (got == AVERROR(ENOMEM)) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
      if (got < 0) {
        countDamaged();  // the loop ends, since each try consumes data
      } else if (auto added = append(chunk); !added) {
        return std::unexpected(added.error());
      }
    }
  }

  // Appends the decoded sound to the chunk, in the requested format.
  Result<void> append(AudioChunk& chunk) {
    if (auto ready = prepareResampler(); !ready) return ready;
    const std::int64_t own = sound_->best_effort_timestamp;
    MediaTime pts = own == AV_NOPTS_VALUE ? next_pts_ : MediaTime(Duration(own));
    pts -= Duration(swr_get_delay(resampler_.get(), kNanosecond.den));  // samples inside the resampler come out first
    const int room = swr_get_out_samples(resampler_.get(), sound_->nb_samples);
    if (room < 0) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    const auto channels = static_cast<std::size_t>(format_.channels);
    const std::size_t before = chunk.samples.size();
    chunk.samples.resize(before + static_cast<std::size_t>(room) * channels);
    auto* out = reinterpret_cast<std::uint8_t*>(chunk.samples.data() + before);
    const int made = swr_convert(resampler_.get(), &out, room, const_cast<const std::uint8_t**>(sound_->extended_data),
                                 sound_->nb_samples);
    chunk.samples.resize(before + static_cast<std::size_t>(std::max(made, 0)) * channels);
    if (made < 0) countDamaged();
    if (before == 0) chunk.pts = pts;
    next_pts_ = pts + fromSeconds(static_cast<double>(std::max(made, 0)) / format_.rate_hz) +
                Duration(swr_get_delay(resampler_.get(), kNanosecond.den));
    av_frame_unref(sound_.get());
    return {};
  }

  // The stream's rate, layout or sample format may change; the old resampler's rest, under a millisecond, is dropped.
  Result<void> prepareResampler() {
    const bool same = resampler_ && last_->sample_rate == sound_->sample_rate && last_->format == sound_->format &&
                      av_channel_layout_compare(&last_->ch_layout, &sound_->ch_layout) == 0;
    if (same) return {};
    AVChannelLayout from{};
    if (sound_->ch_layout.order == AV_CHANNEL_ORDER_UNSPEC) {
      av_channel_layout_default(&from, sound_->ch_layout.nb_channels);
    } else if (av_channel_layout_copy(&from, &sound_->ch_layout) < 0) {
      return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    }
    AVChannelLayout to{};
    av_channel_layout_default(&to, format_.channels);
    SwrContext* context = nullptr;
    swr_alloc_set_opts2(&context, &to, AV_SAMPLE_FMT_FLT, format_.rate_hz, &from,
                        static_cast<AVSampleFormat>(sound_->format), sound_->sample_rate, 0, nullptr);
    av_channel_layout_uninit(&from);
    resampler_.reset(context);
    if (context == nullptr) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    av_opt_set_double(context, "rematrix_maxval", 1.0, 0);
    if (swr_init(context) < 0) {
      resampler_.reset();
      return fail(ErrorCode::Unsupported, "its sound has a channel layout that cannot be mixed down; convert the film");
    }
    last_->sample_rate = sound_->sample_rate;
    last_->format = sound_->format;
    if (av_channel_layout_copy(&last_->ch_layout, &sound_->ch_layout) < 0) {
      return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    }
    return {};
  }

  void flushDecoder() noexcept override {
    avcodec_flush_buffers(context_.get());
    resampler_.reset();
    next_pts_ = MediaTime{};
  }

  void closeDecoder() noexcept override {
    context_.reset();
    resampler_.reset();
    packet_.reset();
    sound_.reset();
    last_.reset();
  }

  CodecContextPtr context_;
  std::unique_ptr<SwrContext, ResamplerDeleter> resampler_;
  PacketPtr packet_;  // reused for each packet
  FramePtr sound_;    // likewise
  FramePtr last_;     // without samples: the format that the resampler was made for
  AVRational time_base_ = kNanosecond;
  AudioFormat format_;
  MediaTime next_pts_;
};

}  // namespace

std::unique_ptr<AudioDecoder> makeFfmpegAudioDecoder() {
  return std::make_unique<FfmpegAudioDecoder>();
}

}  // namespace relievo
