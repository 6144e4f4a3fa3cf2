// SPDX-License-Identifier: Apache-2.0
// Video decoder on libavcodec: software decoding on few threads; returns references to pictures.
#include <cerrno>
#include <cstdint>
#include <span>
#include <utility>

#include "drivers/ffmpeg/bounds/jpeg_bounds.h"
#include "drivers/ffmpeg/bounds/png_bounds.h"
#include "drivers/ffmpeg/coding.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/library.h"
#include "drivers/ffmpeg/pictures/photo_size.h"
#include "drivers/ffmpeg/pictures/picture.h"
#include "drivers/ffmpeg/pictures/picture_memory.h"
#include "drivers/ffmpeg/views/view_pairs.h"

namespace relievo {
namespace {

using namespace ffmpeg;

constexpr int kThreads = 2;         // each thread adds one frame of delay; two use a small box well enough
constexpr int kMaxHeldFrames = 64;  // the pool has no limit of its own; this one makes a leak visible
constexpr Duration kDefaultPeriod = std::chrono::milliseconds(40);  // if neither times nor a rate are known

constexpr const char* kNoMemory = "out of memory in the video decoder";

// True if the decoder concealed lost data in the picture by guesses.
bool isMended(const AVFrame& picture) noexcept {
  return (picture.flags & AV_FRAME_FLAG_CORRUPT) != 0 || picture.decode_error_flags != 0;
}

// True for pictures of a folder or a film that FFmpeg would decode for long, or into much memory.
bool exceedsBound(AVCodecID codec, std::span<const std::uint8_t> picture) {
  if (codec == AV_CODEC_ID_PNG) return exceededPngBound(readable(picture)) != nullptr;
  return codec == AV_CODEC_ID_MJPEG && exceededJpegBound(readable(picture)) != nullptr;
}

// FFmpeg's own decoders of WebM's codecs leave the alpha channel out; libvpx's read it.
const AVCodec* decoderOf(AVCodecID id, bool alpha) noexcept {
  const char* const name = !alpha                  ? nullptr
                           : id == AV_CODEC_ID_VP9 ? "libvpx-vp9"
                           : id == AV_CODEC_ID_VP8 ? "libvpx"
                                                   : nullptr;
  const AVCodec* const with_alpha = name == nullptr ? nullptr : avcodec_find_decoder_by_name(name);
  return with_alpha != nullptr ? with_alpha : avcodec_find_decoder(id);
}

class FfmpegDecoder final : public VideoDecoder, private BlockUser {
 public:
  FfmpegDecoder() noexcept { silenceLibrary(); }

  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.name = "ffmpeg", .max_held_frames = kMaxHeldFrames, .hardware = false};
  }

 private:
  Result<void> openDecoder(const StreamInfo& stream) override {
    packet_.reset(av_packet_alloc());
    picture_.reset(av_frame_alloc());
    if (!packet_ || !picture_) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    time_base_ = kNanosecond;
    sample_aspect_ = {0, 1};
    period_ = stream.frame_period > Duration(0) ? stream.frame_period : kDefaultPeriod;
    next_pts_ = MediaTime{};
    end_pending_ = false;
    views_ = {};
    converter_.forgetScale();

    if (const auto* described = native<NativeStream, NativeStreamDeleter>(stream.native)) {
      time_base_ = described->time_base;
      sample_aspect_ = described->sample_aspect;
      return openCodec(*described->parameters, described->photo, saysAlpha(stream));
    }
    const ParametersPtr parameters = parametersFromWords(stream, AVMEDIA_TYPE_VIDEO);
    if (!parameters) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    return openCodec(*parameters, stream.counted);
  }

  Result<void> openCodec(const AVCodecParameters& parameters, bool photo, bool alpha = false) {
    const AVCodec* const codec = decoderOf(parameters.codec_id, alpha);
    if (codec == nullptr) {
      return fail(ErrorCode::Unsupported, "this FFmpeg has no decoder for this codec; convert the film");
    }
    context_.reset(avcodec_alloc_context3(codec));
    if (!context_) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    if (avcodec_parameters_to_context(context_.get(), &parameters) < 0) {
      return fail(ErrorCode::Corrupt, "the video stream's parameters are invalid; convert the film");
    }
    context_->max_pixels = mostSamples(codec->id, photo);  // also for a film whose size changes
    context_->thread_count = kThreads;
    context_->thread_type = FF_THREAD_FRAME | FF_THREAD_SLICE;
    context_->pkt_timebase = kNanosecond;
    context_->flags |= AV_CODEC_FLAG_UNALIGNED;  // crop exactly to the sample
    memory_.serve(*context_);
    static_cast<void>(askForViews(*context_));
    if (avcodec_open2(context_.get(), codec, nullptr) < 0) {
      return fail(ErrorCode::Corrupt, "the video decoder rejects the stream's parameters; convert the film");
    }
    return {};
  }

  Result<Feed> feedPacket(const Packet& packet) override {
    if (packet.bytes == 0) return Feed::Accepted;  // FFmpeg would take it for the end
    if (!fillPacket(*packet_, packet, time_base_)) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    const bool refused = exceedsBound(context_->codec_id, std::span(packet.data, packet.bytes));
    const int sent = refused ? AVERROR_INVALIDDATA : avcodec_send_packet(context_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (sent == AVERROR(EAGAIN)) return Feed::Full;
    if (sent == AVERROR(ENOMEM)) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    if (sent < 0) countDamaged();
    return Feed::Accepted;
  }

  Result<Progress> receiveFrame(Frame& frame) override {
    for (;;) {
      const int got = avcodec_receive_frame(context_.get(), picture_.get());
      if (got == AVERROR(EAGAIN)) {
        if (!std::exchange(end_pending_, false)) return Progress::NeedsPackets;
        static_cast<void>(avcodec_send_packet(context_.get(), nullptr));  // fails only if it is draining already
        continue;
      }
      if (got == AVERROR(ENOMEM)) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
      ViewPairs::Moment moment;
      if (got == AVERROR_EOF) {
        moment = views_.rest();
        if (!moment.base) return Progress::EndOfStream;
      } else if (got >= 0) {
        FramePtr picture(av_frame_alloc());
        if (!picture) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
        av_frame_move_ref(picture.get(), picture_.get());
        av_dict_free(&picture->metadata);  // a PNG's texts, which nobody reads, nor its profile
        av_frame_remove_side_data(picture.get(), AV_FRAME_DATA_ICC_PROFILE);
        moment = views_.add(std::move(picture));
        if (!moment.base) continue;
      }
      if (moment.base) {
        const MediaTime pts = nextTime(moment.base->best_effort_timestamp);
        if (!isMended(*moment.base)) return deliver(frame, std::move(moment), pts);
      }
      countDamaged();  // the loop ends, since each try consumes a packet or a picture
    }
  }

  Result<Progress> deliver(Frame& frame, ViewPairs::Moment moment, MediaTime pts) {
    auto base = describe(std::move(moment.base), pts);
    if (!base) return std::unexpected(base.error());
    frame = std::move(*base);
    if (moment.second && isMended(*moment.second)) {
      countDamaged();
      moment.second.reset();
    }
    if (!moment.second) return Progress::Picture;
    auto second = describe(std::move(moment.second), pts);
    if (!second) return std::unexpected(second.error());
    if (moment.base_is_right) std::swap(frame, *second);
    frame.right = std::make_shared<const Frame>(std::move(*second));
    return Progress::Picture;
  }

  Result<Frame> describe(FramePtr picture, MediaTime pts) {
#if LIBAVUTIL_VERSION_INT >= AV_VERSION_INT(57, 30, 100)  // FFmpeg 6; older versions have only pkt_duration
    const Duration duration(picture->duration);
#else
    const Duration duration(picture->pkt_duration);
#endif
    const bool floats = isGrayFloat(picture->format);
    if (!describable(picture->format)) {
      auto converted = converter_.convert(*picture);
      if (!converted) return std::unexpected(converted.error());
      picture = std::move(*converted);
    }
    Frame frame = frameOf(std::move(picture), sample_aspect_);
    if (floats) {
      frame.value_per_code = converter_.scale().valuePerCode();
      frame.value_at_zero = converter_.scale().valueAtZero();
    }
    frame.pts = pts;
    frame.duration = duration;
    return withinLimit(std::move(frame));
  }

  // The picture's own time, or one period after the previous picture.
  MediaTime nextTime(std::int64_t own) noexcept {
    const MediaTime pts = own == AV_NOPTS_VALUE ? next_pts_ : MediaTime(Duration(own));
    next_pts_ = pts + period_;
    return pts;
  }

  // FFmpeg drops packets that it has not decoded yet when the end is signalled, so `receiveFrame` signals it later.
  Result<void> startDrain() override {
    end_pending_ = true;
    return {};
  }

  Result<void> flushDecoder() override {
    avcodec_flush_buffers(context_.get());
    next_pts_ = MediaTime{};
    end_pending_ = false;
    views_.dropWaiting();
    return {};
  }

  void closeDecoder() noexcept override {
    context_.reset();
    packet_.reset();
    picture_.reset();
    views_ = {};
  }

  // FFmpeg's codecs read these fields anew for each picture.
  void leaveOut(bool unreferenced) noexcept override {
    context_->skip_frame = unreferenced ? AVDISCARD_NONREF : AVDISCARD_DEFAULT;
  }

  PictureMemory memory_;
  CodecContextPtr context_;
  PacketPtr packet_;  // reused by each feed
  FramePtr picture_;  // reused by each receive
  ViewPairs views_;
  Converter converter_;
  AVRational time_base_ = kNanosecond;  // of the durations in the source's packets
  AVRational sample_aspect_{0, 1};
  Duration period_ = kDefaultPeriod;
  MediaTime next_pts_;
  bool end_pending_ = false;  // drain was requested but not yet signalled to FFmpeg
};

}  // namespace

std::unique_ptr<VideoDecoder> makeFfmpegDecoder() {
  return std::make_unique<FfmpegDecoder>();
}

bool ffmpegDecodesBothViews() noexcept {
  const CodecContextPtr context(avcodec_alloc_context3(avcodec_find_decoder(AV_CODEC_ID_HEVC)));
  return context && askForViews(*context);
}

}  // namespace relievo
