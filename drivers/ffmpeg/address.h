// SPDX-License-Identifier: Apache-2.0
// Where an address leads, and what the library may do on the way there.
#pragma once

#include <cstdint>
#include <string>

extern "C" {
#include <libavutil/dict.h>
}

#include "platform/error.h"

namespace relievo::ffmpeg {

enum class Way : std::uint8_t {
  File,     // and patterns of numbered pictures
  Pipe,     // a named one
  Http,     // with or without TLS; HLS and DASH as well
  Rtsp,     // with or without TLS
  Packets,  // RTP, UDP: whoever sends
  Tcp,
};

struct Address {
  std::string url;  // as the library takes it
  Way way = Way::File;

  [[nodiscard]] bool remote() const noexcept { return way != Way::File && way != Way::Pipe; }
  // Comes at its own pace, once, and has no end that could be told from a broken line.
  [[nodiscard]] bool flows() const noexcept { return remote() && way != Way::Http; }
};

// An existing file is a file whatever its name looks like ("12:30.mkv"). Unsupported: a protocol that is not in the
// list, such as those that read several files, parts of files or other processes.
[[nodiscard]] Result<Address> parseAddress(const std::string& url);

// What goes with the address into avformat_open_input: which further protocols and formats whatever it names may use,
// and how long a silent line is waited for. The caller frees it.
//
//   a file      files (beside it, as the library sees to), and the network where it is a session description
//   a network   the same kind of connection alone, and formats that hold a film: never a list of other addresses but
//               HLS's and DASH's own, never a file of this machine
[[nodiscard]] AVDictionary* optionsFor(const Address& address);

}  // namespace relievo::ffmpeg
