// SPDX-License-Identifier: Apache-2.0
// The kinds of films that are written, told by their names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/coding/video_codec.h"

namespace relievo {

enum class FilmKind : std::uint8_t { Matroska, Mp4, Mov, TransportStream, Hls, Live };

// By the name's ending, or "udp://" before it; nothing for what is not written here.
[[nodiscard]] std::optional<FilmKind> filmKindOf(const std::string& path);
inline constexpr const char* kUnknownKind =
    "unknown kind of film; let its name end in .mkv, .mp4, .m4v, .mov, .ts or .m3u8, or name a line: udp://HOST:PORT";
// Whether players find this codec in films of this kind: FFV1 in Matroska alone.
[[nodiscard]] bool holds(FilmKind kind, VideoCodec codec) noexcept;
inline constexpr const char* kNotHeld =
    "films of this kind do not hold FFV1; write a .mkv, or take another --depth-codec";
// Where the segments of PLAYLIST.m3u8 lie: PLAYLIST.segments beside it, odd letters replaced: a playlist holds
// addresses, in which they would mean something else.
[[nodiscard]] std::string segmentFolderOf(const std::string& playlist);

}  // namespace relievo
