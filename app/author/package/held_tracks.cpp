// SPDX-License-Identifier: Apache-2.0
#include "app/author/package/held_tracks.h"

#include <algorithm>
#include <array>

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace relievo {
namespace {

// Codecs that common players support in a transport stream or an HLS segment.
constexpr std::array kInTransport{
    AV_CODEC_ID_MP1,   AV_CODEC_ID_MP2,          AV_CODEC_ID_MP3,         AV_CODEC_ID_AAC,    AV_CODEC_ID_AAC_LATM,
    AV_CODEC_ID_AC3,   AV_CODEC_ID_EAC3,         AV_CODEC_ID_DTS,         AV_CODEC_ID_TRUEHD, AV_CODEC_ID_OPUS,
    AV_CODEC_ID_S302M, AV_CODEC_ID_DVB_SUBTITLE, AV_CODEC_ID_DVB_TELETEXT};
constexpr std::array kInSegments{AV_CODEC_ID_AAC,  AV_CODEC_ID_AC3,  AV_CODEC_ID_EAC3, AV_CODEC_ID_MP3,
                                 AV_CODEC_ID_FLAC, AV_CODEC_ID_OPUS, AV_CODEC_ID_ALAC};
// FFmpeg's muxer has names for them, but refuses to write them.
constexpr std::array kNotInQuickTime{AV_CODEC_ID_FLAC, AV_CODEC_ID_OPUS, AV_CODEC_ID_TRUEHD};

}  // namespace

bool isTransport(FilmKind kind) noexcept {
  return kind == FilmKind::TransportStream || kind == FilmKind::Live;
}

bool isMp4(FilmKind kind) noexcept {
  return kind == FilmKind::Mp4 || kind == FilmKind::Mov || kind == FilmKind::Hls;
}

bool canHold(const AVFormatContext& film, FilmKind kind, AVCodecID codec) {
  if (isTransport(kind)) return std::ranges::find(kInTransport, codec) != kInTransport.end();
  if (kind == FilmKind::Hls) return std::ranges::find(kInSegments, codec) != kInSegments.end();
  if (kind == FilmKind::Mov && std::ranges::find(kNotInQuickTime, codec) != kNotInQuickTime.end()) return false;
  return avformat_query_codec(film.oformat, codec, FF_COMPLIANCE_NORMAL) == 1;
}

AVCodecID textOf(FilmKind kind) noexcept {
  if (kind == FilmKind::Matroska) return AV_CODEC_ID_SUBRIP;
  return isMp4(kind) && kind != FilmKind::Hls ? AV_CODEC_ID_MOV_TEXT : AV_CODEC_ID_NONE;
}

const char* nameOf(FilmKind kind) noexcept {
  switch (kind) {
    case FilmKind::Matroska:
      return "Matroska";
    case FilmKind::Mp4:
      return "MP4";
    case FilmKind::Mov:
      return "QuickTime";
    case FilmKind::TransportStream:
    case FilmKind::Live:
      return "a transport stream";
    case FilmKind::Hls:
      return "an HLS film";
  }
  return "";
}

}  // namespace relievo
