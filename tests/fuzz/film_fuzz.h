// SPDX-License-Identifier: Apache-2.0
// Bytes as a film: opened, read, sought, read again.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <memory>
#include <span>
#include <string>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "platform/log.h"
#include "platform/unique_fd.h"

namespace relievo::test {

// Reads all the memory that the frame announces.
inline void touch(const Frame& frame) {
  if (frame.empty()) return;
  const volatile std::uint8_t last = frame.planes[0].data[(frame.height - 1) * frame.planes[0].stride_bytes];
  static_cast<void>(last);
}

inline void playBytes(
    std::span<const std::uint8_t> bytes, std::unique_ptr<MediaSource> (*make_source)(),
    decltype(PairReader::Backends::make_decoder) make_decoder = [](const StreamInfo&) { return makeFfmpegDecoder(); }) {
  setLogLevel(LogLevel::Error);
  const UniqueFd file(::memfd_create("film", MFD_CLOEXEC));
  if (::write(file.get(), bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) return;
  PairReader reader({.make_source = [make_source](const std::string&) { return make_source(); },
                     .make_decoder = std::move(make_decoder),
                     .read_text = {}});
  if (!reader.open({.url = "/proc/self/fd/" + std::to_string(file.get())})) return;
  const auto readSome = [&reader] {
    for (int i = 0; i < 4; ++i) {
      const auto pair = reader.next();
      if (!pair || !*pair) return;
      touch((*pair)->color);
      touch((*pair)->depth);
    }
  };
  readSome();
  static_cast<void>(reader.seek(mediaTime(0.5)));
  readSome();
}

}  // namespace relievo::test
