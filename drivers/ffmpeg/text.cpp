// SPDX-License-Identifier: Apache-2.0
// Reads the text at an address through libavformat's protocols.
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "drivers/ffmpeg/address.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/library.h"
#include "drivers/ffmpeg/local_file.h"
#include "drivers/ffmpeg/network_error.h"
#include "drivers/ffmpeg/opening/apart.h"
#include "drivers/ffmpeg/refusal.h"
#include "drivers/ffmpeg/watch.h"
#include "platform/files/answered_file.h"

extern "C" {
#include <libavformat/avio.h>
}

namespace relievo {

using namespace ffmpeg;

namespace {

constexpr const char* kTooLong = "it is too long for a text file; check the address";

Error lateText(Way way) noexcept {
  if (way != Way::Pipe) return kLateAnswer;
  return {ErrorCode::Timeout, 0, "the list did not come whole through the pipe within 30 s; check what writes to it"};
}

Result<std::string> readFile(const std::string& path, std::size_t most_bytes) {
  const auto file = AnsweredFile::open(path);
  if (!file)
    return std::unexpected(file.error().os_error == 0 ? file.error() : openError(AVERROR(file.error().os_error)));
  std::vector<std::uint8_t> text(most_bytes + 1);
  const auto got = file->read(0, text);
  if (!got) return std::unexpected(got.error());
  if (*got > most_bytes) return fail(ErrorCode::Corrupt, kTooLong);
  return std::string(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(*got));
}

// The thread that reads may be left behind: it shares this.
struct Reading {
  Watch watch;
  Result<std::string> text;
};

Result<std::string> fetch(const Address& address, std::size_t most_bytes, Watch& watch) {
  const LibraryWords words;
  const auto explain = [&](int code) {
    return watch.explain(address.remote() ? networkError(code, words.last()) : openError(code));
  };
  const AVIOInterruptCB interrupt{.callback = Watch::callback, .opaque = &watch};
  AVDictionary* options = optionsFor(address);
  AVIOContext* file = nullptr;
  const int opened = avio_open2(&file, address.url.c_str(), AVIO_FLAG_READ, &interrupt, &options);
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
  if (text.size() > most_bytes) return fail(ErrorCode::Corrupt, kTooLong);
  return text;
}

}  // namespace

Result<std::string> readFfmpegText(const std::string& url, std::size_t most_bytes, const std::atomic<bool>& cancelled) {
  silenceLibrary();
  auto address = parseAddress(url);
  if (!address) return std::unexpected(address.error());
  if (address->way == Way::File) return readFile(localPathOf(address->url), most_bytes);
  const Error late = lateText(address->way);
  if (address->way == Way::Pipe) *address = {"file:" + url, Way::File};
  const auto reading = std::make_shared<Reading>();
  Watch& watch = reading->watch;
  watch.begin(kOpenPatience, late);
  const auto work = [reading, address = *address, most_bytes] {
    reading->text = fetch(address, most_bytes, reading->watch);
  };
  const auto ended = runApart(work, [&] {
    if (cancelled) watch.cancel();
    return watch.givesUp();
  });
  if (!ended) return std::unexpected(ended.error());
  if (*ended) return std::move(reading->text);
  return std::unexpected(watch.explain(late));
}

}  // namespace relievo
