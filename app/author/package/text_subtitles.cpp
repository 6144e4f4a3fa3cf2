// SPDX-License-Identifier: Apache-2.0
// FFmpeg's decoders of text all produce the same form of events, which its encoders accept.
#include "app/author/package/text_subtitles.h"

#include <cerrno>
#include <cstring>
#include <span>
#include <string_view>

namespace relievo {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 16;  // of one event, coded
constexpr const char* kNewLine = "\\N";
constexpr Error kNoMemory{ErrorCode::Exhausted, ENOMEM, "out of memory for subtitles"};
constexpr Error kCannotConvert{ErrorCode::Unsupported, 0, "this FFmpeg cannot convert these subtitles"};

// In the form that FFmpeg's decoders produce, the text of an event follows eight commas.
std::size_t textAt(std::string_view event) noexcept {
  std::size_t at = 0;
  for (int commas = 0; commas < 8; ++commas) at = event.find(',', at) + 1;
  return at;
}

std::string textOf(const AVSubtitle& subtitle) {
  std::string text;
  for (const AVSubtitleRect* const event : std::span(subtitle.rects, subtitle.num_rects)) {
    if (event->ass == nullptr) continue;
    text += (text.empty() ? "" : kNewLine) + std::string(event->ass).substr(textAt(event->ass));
  }
  return text;
}

// Puts lines above the subtitle's own. False: out of memory.
bool prepend(const std::string& lines, AVSubtitle& subtitle) {
  if (subtitle.num_rects == 0 || subtitle.rects[0]->ass == nullptr) return true;
  std::string event = subtitle.rects[0]->ass;
  event.insert(textAt(event), lines + kNewLine);
  av_free(subtitle.rects[0]->ass);
  subtitle.rects[0]->ass = av_strdup(event.c_str());
  return subtitle.rects[0]->ass != nullptr;
}

}  // namespace

bool isTextSubtitle(AVCodecID codec) noexcept {
  const AVCodecDescriptor* const described = avcodec_descriptor_get(codec);
  return described != nullptr && (described->props & AV_CODEC_PROP_TEXT_SUB) != 0;
}

Result<std::unique_ptr<TextSubtitles>> TextSubtitles::create(const AVCodecParameters& from, AVRational time_base,
                                                             AVCodecID to) {
  auto made = std::make_unique<TextSubtitles>();
  const AVCodec* const decoder = avcodec_find_decoder(from.codec_id);
  const AVCodec* const encoder = avcodec_find_encoder(to);
  if (decoder == nullptr || encoder == nullptr) return std::unexpected(kCannotConvert);
  made->reader_.reset(avcodec_alloc_context3(decoder));
  made->writer_.reset(avcodec_alloc_context3(encoder));
  if (!made->reader_ || !made->writer_) return std::unexpected(kNoMemory);
  AVCodecContext& reader = *made->reader_;
  AVCodecContext& writer = *made->writer_;
  if (avcodec_parameters_to_context(&reader, &from) < 0) return std::unexpected(kNoMemory);
  reader.pkt_timebase = time_base;
  if (avcodec_open2(&reader, decoder, nullptr) < 0) return std::unexpected(kCannotConvert);
  const auto header_bytes = static_cast<std::size_t>(reader.subtitle_header_size);
  writer.subtitle_header = static_cast<std::uint8_t*>(av_mallocz(header_bytes + 1));  // the context frees it
  if (writer.subtitle_header == nullptr) return std::unexpected(kNoMemory);
  if (header_bytes > 0) std::memcpy(writer.subtitle_header, reader.subtitle_header, header_bytes);
  writer.subtitle_header_size = reader.subtitle_header_size;
  writer.time_base = {1, 1000};
  if (avcodec_open2(&writer, encoder, nullptr) < 0) return std::unexpected(kCannotConvert);
  made->coded_.resize(kMostBytes);
  return made;
}

Result<void> TextSubtitles::describe(AVCodecParameters& parameters) const {
  if (avcodec_parameters_from_context(&parameters, writer_.get()) < 0) return std::unexpected(kNoMemory);
  return {};
}

Result<bool> TextSubtitles::convert(AVPacket& packet, bool joins) {
  AVSubtitle subtitle{};
  int found = 0;
  if (avcodec_decode_subtitle2(reader_.get(), &subtitle, &found, &packet) < 0 || found == 0) return false;
  if (joins && !prepend(last_, subtitle)) {
    avsubtitle_free(&subtitle);
    return std::unexpected(kNoMemory);
  }
  last_ = textOf(subtitle);
  const int bytes = avcodec_encode_subtitle(writer_.get(), coded_.data(), static_cast<int>(coded_.size()), &subtitle);
  avsubtitle_free(&subtitle);
  if (bytes <= 0) return false;
  AVBufferRef* const buffer = av_buffer_alloc(static_cast<std::size_t>(bytes) + AV_INPUT_BUFFER_PADDING_SIZE);
  if (buffer == nullptr) return std::unexpected(kNoMemory);
  std::memset(buffer->data, 0, buffer->size);
  std::memcpy(buffer->data, coded_.data(), static_cast<std::size_t>(bytes));
  av_buffer_unref(&packet.buf);
  packet.buf = buffer;
  packet.data = buffer->data;
  packet.size = bytes;
  return true;
}

}  // namespace relievo
