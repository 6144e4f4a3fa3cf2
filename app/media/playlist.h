// SPDX-License-Identifier: Apache-2.0
// Playlists: M3U, as every player writes them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/failure.h"

namespace relievo {

struct PlaylistEntry {
  std::string url;        // as it is opened: what was relative is joined to where the playlist lies
  std::string depth_url;  // of a film in two files; else empty
  std::string title;      // empty: none is told
  bool refused = false;   // it names what a list may not open
  bool operator==(const PlaylistEntry&) const = default;
};

// Whether a source of this name may be a list: only then is it worth to look at its text.
[[nodiscard]] bool mayBePlaylist(std::string_view url);
// Whether `text`, the beginning of a source, or its name is that of a list of films. An HLS playlist, which begins
// alike, is one film.
[[nodiscard]] bool isPlaylist(std::string_view url, std::string_view text);

// One entry a line; `#EXTINF:seconds,title` before one names it, `#RELIEVO-DEPTH:url` before one says where its depth
// is. Other lines that begin with # say nothing here. `from`: the file or the URL that the playlist was read from.
//
// A list on the network names things on the network alone (http, https, rtsp, rtsps, rtp, udp, tcp): it must not make a
// box open its own files, or join them by FFmpeg's other protocols. A list in a file may name files besides. An entry
// that tries more is refused, the others are not. Corrupt: a list without an entry, or of more than kMostEntries.
inline constexpr std::size_t kMostEntries = 10'000;
[[nodiscard]] Outcome<std::vector<PlaylistEntry>> parsePlaylist(std::string_view text, const std::string& from);

}  // namespace relievo
