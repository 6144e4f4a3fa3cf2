// SPDX-License-Identifier: Apache-2.0
// Any text as a list of films: from the network it opens nothing that is not on the network.
#include <cstdlib>
#include <string_view>

#include "app/media/playlist.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  static_cast<void>(parsePlaylist(text, "/media/list.m3u"));
  const auto films = parsePlaylist(text, "http://host/folder/list.m3u?key=1");
  if (!films) return 0;
  for (const PlaylistEntry& film : *films) {
    for (const std::string& url : {film.url, film.depth_url}) {
      std::string scheme = url.substr(0, url.find(':'));
      for (char& c : scheme) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      const bool allowed = scheme == "http" || scheme == "https" || scheme == "rtsp" || scheme == "udp";
      if (!url.empty() && !allowed) std::abort();
    }
  }
  return 0;
}
