// SPDX-License-Identifier: Apache-2.0
// Playlists in M3U format.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/failure.h"

namespace relievo {

struct PlaylistEntry {
  std::string url;        // ready to open: relative paths are joined to the playlist's folder
  std::string depth_url;  // of a film in two files; else empty
  std::string title;      // empty: not given
  bool refused = false;   // names something that a playlist may not open
  bool operator==(const PlaylistEntry&) const = default;
};

// Without the ? and # parts of a network address; a file's name may hold both.
[[nodiscard]] std::string_view withoutQuery(std::string_view url);
// The path of "file:PATH" and "file://HOST/PATH", with %20 and the like decoded.
[[nodiscard]] std::string pathOfFileUrl(std::string_view url);
// A source as someone names it: the path if it is an address "file:///.." or "file:..", as some desktops and programs
// write; else unchanged.
[[nodiscard]] std::string sourceNamed(const std::string& words);
// Whether the name of this source could be a playlist's: only then is its text read.
[[nodiscard]] bool mayBePlaylist(std::string_view url);
// Whether `url` or `text`, the beginning of its content, is a list of films. An HLS playlist begins alike but is one
// film.
[[nodiscard]] bool isPlaylist(std::string_view url, std::string_view text);

// One entry per line. `#EXTINF:seconds,title` before an entry gives its title, `#RELIEVO-DEPTH:url` its depth source.
// Other lines that begin with # are ignored. `from` is the file or URL of the playlist.
//
// A network playlist may only name network addresses (http, https, rtsp, rtsps, rtp, udp, tcp), so that it cannot open
// local files, directly or through FFmpeg's other protocols. A playlist in a file may also name files. A forbidden
// entry is marked as refused; the others stay usable. Corrupt: a playlist without entries or with more than
// kMostEntries.
inline constexpr std::size_t kMostEntries = 10'000;
[[nodiscard]] Outcome<std::vector<PlaylistEntry>> parsePlaylist(std::string_view text, const std::string& from);

}  // namespace relievo
