// SPDX-License-Identifier: Apache-2.0
// The text at an address, by libavformat's own protocols.
#include <sys/stat.h>

#include <array>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/library.h"

extern "C" {
#include <libavformat/avio.h>
}

namespace relievo {

using namespace ffmpeg;

Result<std::string> readFfmpegText(const std::string& url, std::size_t most_bytes, const std::atomic<bool>& cancelled) {
  silenceLibrary();
  const auto cancel = [](void* flag) { return static_cast<const std::atomic<bool>*>(flag)->load() ? 1 : 0; };
  const AVIOInterruptCB interrupt{.callback = cancel, .opaque = const_cast<std::atomic<bool>*>(&cancelled)};
  const auto explain = [&cancelled](int code) {
    return cancelled ? Error{ErrorCode::Cancelled, 0, "interrupted while waiting for the text"} : openError(code);
  };
  struct stat status{};
  const std::string address = ::stat(url.c_str(), &status) == 0 ? "file:" + url : url;
  AVDictionary* options = nullptr;
  av_dict_set(&options, "rw_timeout", "10000000", 0);  // us
  av_dict_set(&options, "protocol_whitelist", "file,http,https,tcp,tls", 0);
  AVIOContext* file = nullptr;
  const int opened = avio_open2(&file, address.c_str(), AVIO_FLAG_READ, &interrupt, &options);
  av_dict_free(&options);
  if (opened < 0) return std::unexpected(explain(opened));

  std::string text;
  std::array<unsigned char, 4096> block;
  int got = 0;
  while (text.size() <= most_bytes && (got = avio_read_partial(file, block.data(), block.size())) > 0) {
    text.append(reinterpret_cast<const char*>(block.data()), static_cast<std::size_t>(got));
  }
  avio_closep(&file);
  if (got < 0 && got != AVERROR_EOF) return std::unexpected(explain(got));
  if (text.size() > most_bytes) return fail(ErrorCode::Corrupt, "it is too long for a text; is it one?");
  return text;
}

}  // namespace relievo
