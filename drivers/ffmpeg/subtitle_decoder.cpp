// SPDX-License-Identifier: Apache-2.0
// Subtitle decoder on libavcodec: every coding of text becomes lines of Advanced SubStation, pictures become RGBA.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "drivers/ffmpeg/coding.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/library.h"

namespace relievo {
namespace {

using namespace ffmpeg;

constexpr const char* kNoMemory = "out of memory in the subtitle decoder";
constexpr std::uint32_t kForever = 0xffffffff;  // FFmpeg's value for an unknown end
// Text in binary codes, which a byte that is no UTF-8 belongs to.
constexpr std::array kCodedText{AV_CODEC_ID_MOV_TEXT, AV_CODEC_ID_EIA_608, AV_CODEC_ID_ARIB_CAPTION};

// Old files without a mark of their encoding: each byte that is no UTF-8 is taken for Latin-1.
bool isUtf8(const std::uint8_t* data, std::size_t bytes) noexcept {
  for (std::size_t i = 0; i < bytes;) {
    const std::uint8_t first = data[i++];
    const int more = first < 0x80 ? 0 : first >> 5 == 6 ? 1 : first >> 4 == 14 ? 2 : first >> 3 == 30 ? 3 : -1;
    if (more < 0) return false;
    for (int k = 0; k < more; ++k) {
      if (i == bytes || data[i] >> 6 != 2) return false;
      ++i;
    }
  }
  return true;
}

std::string fromLatin1(const std::uint8_t* data, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) {
    if (data[i] < 0x80) {
      text += static_cast<char>(data[i]);
    } else {
      text += static_cast<char>(0xc0 | data[i] >> 6);
      text += static_cast<char>(0x80 | (data[i] & 0x3f));
    }
  }
  return text;
}

// A picture of up to 256 colours.
SubtitlePicture pictureOf(const AVSubtitleRect& rect) {
  SubtitlePicture picture{.x = rect.x, .y = rect.y, .width = rect.w, .height = rect.h, .rgba = {}};
  picture.rgba.resize(static_cast<std::size_t>(rect.w) * static_cast<std::size_t>(rect.h) * 4);
  std::uint8_t* out = picture.rgba.data();
  for (int r = 0; r < rect.h; ++r) {
    const std::uint8_t* const row = rect.data[0] + static_cast<std::ptrdiff_t>(r) * rect.linesize[0];
    for (int c = 0; c < rect.w; ++c) {
      std::uint32_t argb = 0;
      std::memcpy(&argb, rect.data[1] + std::ptrdiff_t{4} * row[c], 4);
      const std::uint32_t opacity = argb >> 24;
      for (const int shift : {16, 8, 0}) {
        *out++ = static_cast<std::uint8_t>(((argb >> shift & 0xff) * opacity + 127) / 255);
      }
      *out++ = static_cast<std::uint8_t>(opacity);
    }
  }
  return picture;
}

class FfmpegSubtitleDecoder final : public SubtitleDecoder {
 public:
  FfmpegSubtitleDecoder() noexcept { silenceLibrary(); }

  Result<void> open(const StreamInfo& stream) override {
    packet_.reset(av_packet_alloc());
    if (!packet_) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    if (const auto* described = native<NativeStream, NativeStreamDeleter>(stream.native)) {
      time_base_ = described->time_base;
      return openCodec(*described->parameters);
    }
    const ParametersPtr parameters = parametersFromWords(stream, AVMEDIA_TYPE_SUBTITLE);
    if (!parameters) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    return openCodec(*parameters);
  }

  std::optional<Subtitle> decode(const Packet& packet) override {
    if (packet.bytes == 0 || !packet.pts || !fillPacket(*packet_, packet, time_base_)) return std::nullopt;
    if (text_ && !isUtf8(packet.data, packet.bytes)) recode(packet);
    AVSubtitle made{};
    int found = 0;
    const Duration length(std::max<std::int64_t>(packet_->duration, 0));
    const int code = avcodec_decode_subtitle2(context_.get(), &made, &found, packet_.get());
    av_packet_unref(packet_.get());
    if (code < 0 || found == 0) return std::nullopt;
    Subtitle subtitle = take(made);
    subtitle.begin = *packet.pts + std::chrono::milliseconds(made.start_display_time);
    const bool told = made.end_display_time > made.start_display_time && made.end_display_time != kForever;
    if (told) subtitle.end = *packet.pts + std::chrono::milliseconds(made.end_display_time);
    else if (length > Duration(0)) subtitle.end = *packet.pts + length;
    avsubtitle_free(&made);
    return subtitle;
  }

  void flush() noexcept override { avcodec_flush_buffers(context_.get()); }

 private:
  Result<void> openCodec(const AVCodecParameters& parameters) {
    const AVCodec* const codec = avcodec_find_decoder(parameters.codec_id);
    if (codec == nullptr) {
      return fail(ErrorCode::Unsupported, "this FFmpeg has no decoder for its subtitles; convert them");
    }
    context_.reset(avcodec_alloc_context3(codec));
    if (!context_) return fail(ErrorCode::Exhausted, kNoMemory, ENOMEM);
    context_->pkt_timebase = kNanosecond;
    const bool opened = avcodec_parameters_to_context(context_.get(), &parameters) >= 0 &&
                        avcodec_open2(context_.get(), codec, nullptr) >= 0;
    if (!opened) return fail(ErrorCode::Corrupt, "the subtitles' parameters are invalid; convert them");
    context_->pkt_timebase = kNanosecond;
    text_ = (avcodec_descriptor_get(parameters.codec_id)->props & AV_CODEC_PROP_TEXT_SUB) != 0 &&
            std::ranges::find(kCodedText, parameters.codec_id) == kCodedText.end();
    const auto* const head = reinterpret_cast<const char*>(context_->subtitle_header);
    styles_ = std::make_shared<const std::string>(
        head == nullptr ? std::string() : std::string(head, static_cast<std::size_t>(context_->subtitle_header_size)));
    return {};
  }

  void recode(const Packet& packet) {
    const std::string text = fromLatin1(packet.data, packet.bytes);
    const std::int64_t duration = packet_->duration;
    av_packet_unref(packet_.get());
    if (av_new_packet(packet_.get(), static_cast<int>(text.size())) < 0) return;
    std::memcpy(packet_->data, text.data(), text.size());
    packet_->pts = packet_->dts = packet.pts->time_since_epoch().count();
    packet_->duration = duration;
  }

  Subtitle take(const AVSubtitle& made) const {
    Subtitle subtitle;
    subtitle.styles = styles_;
    subtitle.canvas_width = context_->width;
    subtitle.canvas_height = context_->height;
    for (unsigned i = 0; i < made.num_rects; ++i) {
      const AVSubtitleRect& rect = *made.rects[i];
      if (rect.ass != nullptr) subtitle.lines.emplace_back(rect.ass);
      else if (rect.type == SUBTITLE_BITMAP && rect.w > 0 && rect.h > 0) subtitle.pictures.push_back(pictureOf(rect));
    }
    return subtitle;
  }

  CodecContextPtr context_;
  PacketPtr packet_;  // reused for each packet
  AVRational time_base_ = kNanosecond;
  bool text_ = false;
  std::shared_ptr<const std::string> styles_;
};

}  // namespace

std::unique_ptr<SubtitleDecoder> makeFfmpegSubtitleDecoder() {
  return std::make_unique<FfmpegSubtitleDecoder>();
}

}  // namespace relievo
