// SPDX-License-Identifier: Apache-2.0
// The kinds of films that can be written, by name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/coding/video_codec.h"

namespace relievo {

enum class FilmKind : std::uint8_t { Matroska, Mp4, Mov, TransportStream, Hls, Live };

// By the file extension or the prefix "udp://" or "srt://"; nullopt for unknown ones.
[[nodiscard]] std::optional<FilmKind> filmKindOf(const std::string& path);
inline constexpr const char* kUnknownKind =
    "unknown kind of film; use .mkv, .mp4, .m4v, .mov, .ts, .m3u8, udp://HOST:PORT or srt://HOST:PORT";
// Whether players support this codec in films of this kind: FFV1 only in Matroska.
[[nodiscard]] bool holds(FilmKind kind, VideoCodec codec) noexcept;
inline constexpr const char* kNotHeld =
    "this kind of film cannot hold FFV1; write a .mkv, or choose another --depth-codec";
// The folder for the segments of PLAYLIST.m3u8: PLAYLIST.segments beside it. Characters with a meaning in URLs are
// replaced, because a playlist contains URLs.
[[nodiscard]] std::string segmentFolderOf(const std::string& playlist);

}  // namespace relievo
