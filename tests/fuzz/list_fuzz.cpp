// SPDX-License-Identifier: Apache-2.0
// Any text as a playlist: one from the network names only network addresses.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "app/media/playlist.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  static_cast<void>(parsePlaylist(text, "/media/list.m3u"));
  const auto films = parsePlaylist(text, "http://host/folder/list.m3u?key=1");
  if (!films) return 0;
  constexpr std::array<std::string_view, 7> kNetwork{"http", "https", "rtsp", "rtsps", "rtp", "udp", "tcp"};
  for (const PlaylistEntry& film : *films) {
    if (film.refused) continue;
    for (const std::string& url : {film.url, film.depth_url}) {
      std::string scheme = url.substr(0, url.find(':'));
      for (char& c : scheme) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (!url.empty() && std::ranges::find(kNetwork, scheme) == kNetwork.end()) std::abort();
    }
  }
  return 0;
}
