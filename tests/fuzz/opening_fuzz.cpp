// SPDX-License-Identifier: Apache-2.0
// Any bytes as a film: opened, read, sought, read again. FFmpeg itself is not instrumented; its output passes through
// our code.
#include <sys/mman.h>
#include <unistd.h>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "platform/log.h"
#include "platform/unique_fd.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  setLogLevel(LogLevel::Error);
  const UniqueFd file(::memfd_create("film", MFD_CLOEXEC));
  if (::write(file.get(), bytes, size) != static_cast<ssize_t>(size)) return 0;
  PairReader reader({.make_source = [](const std::string&) { return makeFfmpegSource(); },
                     .make_decoder = [](const StreamInfo&) { return makeFfmpegDecoder(); },
                     .read_text = {}});
  if (!reader.open({.url = "/proc/self/fd/" + std::to_string(file.get())})) return 0;
  const auto readSome = [&reader] {
    for (int i = 0; i < 4; ++i) {
      const auto pair = reader.next();
      if (!pair || !*pair) return;
      // Reads all the memory that the frames announce.
      for (const Frame* frame : {&(*pair)->color, &(*pair)->depth}) {
        if (frame->empty()) continue;
        const volatile std::uint8_t last = frame->planes[0].data[(frame->height - 1) * frame->planes[0].stride_bytes];
        static_cast<void>(last);
      }
    }
  };
  readSome();
  static_cast<void>(reader.seek(mediaTime(0.5)));
  readSome();
  return 0;
}
