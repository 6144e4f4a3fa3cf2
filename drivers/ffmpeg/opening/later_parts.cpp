// SPDX-License-Identifier: Apache-2.0
// Rewrites lists of parts (RFC 8216).
#include "drivers/ffmpeg/opening/later_parts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>

#include "drivers/ffmpeg/opening/lists.h"

extern "C" {
#include <libavutil/error.h>
#include <libavutil/mem.h>
}

namespace relievo::ffmpeg {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20;
constexpr int kBlock = 4096;
constexpr std::string_view kLength = "#EXTINF:", kNumber = "#EXT-X-MEDIA-SEQUENCE:", kRange = "#EXT-X-BYTERANGE:",
                           kJump = "#EXT-X-DISCONTINUITY";

// Of one part, as a byte range: those that hold for all later parts are others.
constexpr std::array<std::string_view, 4> kOfOnePart{kRange, "#EXT-X-PROGRAM-DATE-TIME:", "#EXT-X-GAP",
                                                     "#EXT-X-BITRATE:"};

bool isOfOnePart(std::string_view line) noexcept {
  return line.starts_with(kLength) || std::ranges::any_of(kOfOnePart, [&](auto tag) { return line.starts_with(tag); });
}

// Whether parts may be taken away from the front.
bool mayBeShortened(std::string_view list) noexcept {
  const auto has = [list](std::string_view tag) { return list.find(tag) != std::string_view::npos; };
  return has(kLength) && has("#EXT-X-ENDLIST");
}

// With the place of its first byte, which is else that behind the range before, `next`.
std::string withPlace(std::string range, std::uint64_t& next) {
  char* end = nullptr;
  const std::uint64_t bytes = std::strtoull(range.c_str() + kRange.size(), &end, 10);
  if (*end == '@') next = std::strtoull(end + 1, nullptr, 10);
  else range.insert(static_cast<std::size_t>(end - range.c_str()), "@" + std::to_string(next));
  next += bytes;
  return range;
}

struct Text {
  std::string bytes;
  std::size_t read = 0;
};

int readSome(void* opaque, std::uint8_t* to, int bytes) {
  auto& text = *static_cast<Text*>(opaque);
  const std::size_t some = std::min(static_cast<std::size_t>(bytes), text.bytes.size() - text.read);
  if (some == 0) return AVERROR_EOF;
  std::copy_n(text.bytes.begin() + static_cast<std::ptrdiff_t>(text.read), some, to);
  text.read += some;
  return static_cast<int>(some);
}

}  // namespace

std::string laterParts(std::string_view list, Duration from) {
  if (!mayBeShortened(list)) return std::string(list);
  std::string whole, part, last;  // what holds for the film, and for the next part; the last part left out
  std::size_t last_place = 0;
  Duration end{0};
  std::uint64_t first = 0, left_out = 0, next_byte = 0;
  bool begun = false;
  const auto begin = [&] {
    if (!begun && left_out > 0) {
      whole.insert(last_place, last);
      --left_out;
    }
    begun = true;
  };
  while (!list.empty()) {
    const std::size_t length = std::min(list.find('\n'), list.size() - 1) + 1;
    std::string line(list.substr(0, length));
    list.remove_prefix(length);
    if (line.starts_with(kNumber)) {
      first = std::strtoull(line.c_str() + kNumber.size(), nullptr, 10);
      continue;
    }
    if (line.starts_with(kRange)) line = withPlace(std::move(line), next_byte);
    if (line.starts_with(kJump) && !line.starts_with("#EXT-X-DISCONTINUITY-") && left_out > 0) begin();
    if (line.starts_with(kLength)) end += fromSeconds(std::strtod(line.c_str() + kLength.size(), nullptr));
    const bool is_part = line[0] != '#' && line.find_first_not_of(" \t\r\n") != std::string::npos;
    if (!is_part) {
      (isOfOnePart(line) ? part : whole) += line;
      continue;
    }
    if (part.find(kRange) == std::string::npos) next_byte = 0;
    begun = begun || end > from;
    if (begun) {
      whole += part + line;
    } else {
      ++left_out;
      last = part + line;
      last_place = whole.size();
    }
    part.clear();
  }
  begin();
  const std::size_t second = whole.find('\n') + 1;  // the first line says that it is a list
  return whole.insert(second, std::string(kNumber) + std::to_string(first + left_out) + "\n");
}

AVIOContext* openLaterParts(AVIOContext& list, Duration from, const std::string& own) {
  auto text = std::make_unique<Text>();
  std::array<unsigned char, kBlock> block{};
  int got = 0;
  while (text->bytes.size() <= kMostBytes && (got = avio_read(&list, block.data(), kBlock)) > 0) {
    text->bytes.append(reinterpret_cast<const char*>(block.data()), static_cast<std::size_t>(got));
  }
  text->bytes = laterParts(text->bytes, from);
  if (!own.empty()) text->bytes = withWholeAddresses(text->bytes, own);
  auto* const buffer = static_cast<unsigned char*>(av_malloc(kBlock));
  if (buffer == nullptr) return nullptr;
  AVIOContext* const file = avio_alloc_context(buffer, kBlock, 0, text.get(), readSome, nullptr, nullptr);
  if (file == nullptr) {
    av_free(buffer);
    return nullptr;
  }
  static_cast<void>(text.release());  // freed by closeLaterParts
  return file;
}

bool isLaterParts(const AVIOContext* file) noexcept {
  return file != nullptr && file->read_packet == readSome;
}

void closeLaterParts(AVIOContext* file) noexcept {
  const std::unique_ptr<Text> text(static_cast<Text*>(file->opaque));
  av_free(std::exchange(file->buffer, nullptr));
  avio_context_free(&file);
}

}  // namespace relievo::ffmpeg
