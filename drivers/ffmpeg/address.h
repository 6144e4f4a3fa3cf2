// SPDX-License-Identifier: Apache-2.0
// Classifies a source's address, and restricts what FFmpeg may open from there.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

extern "C" {
#include <libavutil/dict.h>
}

#include "platform/error.h"

namespace relievo::ffmpeg {

enum class Way : std::uint8_t {
  File,     // also patterns of numbered pictures
  Pipe,     // a named pipe
  Http,     // with or without TLS; HLS and DASH as well
  Rtsp,     // with or without TLS
  Packets,  // RTP and UDP, from any sender
  Tcp,
};

struct Address {
  std::string url;  // in FFmpeg's form
  Way way = Way::File;

  [[nodiscard]] bool remote() const noexcept { return way != Way::File && way != Way::Pipe; }
  // A real-time stream: sent once, at its own pace, and its end cannot be told from a broken connection.
  [[nodiscard]] bool flows() const noexcept { return remote() && way != Way::Http; }
};

// As FFmpeg parses it: "http" of "http://..", "concat" of "concat:a|b", "subfile" of "subfile,,start,1,:a".
[[nodiscard]] std::string_view schemeOf(std::string_view url) noexcept;

// The name of an existing file is a file even if it looks like a URL ("12:30.mkv"). Unsupported: a protocol that is not
// in the list, such as those that read several files, parts of files or other processes; and packets without a port.
[[nodiscard]] Result<Address> parseAddress(const std::string& url);

// The options for avformat_open_input: the protocols and formats that anything named by the source may use, and the
// time-outs. The caller frees them.
//
//   a file may name      files (FFmpeg limits these to files beside it), and network streams if it is a session
//                        description
//   a network source     only the same kind of connection and formats of films: no lists of other addresses except HLS
//                        and DASH playlists, no local files
[[nodiscard]] AVDictionary* optionsFor(const Address& address);

}  // namespace relievo::ffmpeg
