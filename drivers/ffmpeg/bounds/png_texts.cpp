// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/bounds/png_texts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

extern "C" {
#include <libavutil/intreadwrite.h>
}

namespace relievo::ffmpeg {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kHeadBytes = 8;  // the signature; a chunk's length and type
constexpr std::uint64_t kSumBytes = 4;
using Head = std::array<std::uint8_t, kHeadBytes>;

// `read` fills a head from a place and says whether all of it is there.
template <typename Read>
bool countsTooMany(const Read& read) {
  Head head{};
  const auto type = [&head](std::size_t from) {
    return std::string_view(reinterpret_cast<const char*>(head.data()) + from, kHeadBytes - from);
  };
  if (!read(0, head) || type(0) != "\x89PNG\r\n\x1a\n"sv) return false;
  int texts = 0, chunks = 0, profiles = 0;
  std::uint64_t packed = 0;
  const auto too_many = [&] { return texts > kMostTexts || chunks > kMostChunks || packed > kMostPackedBytes; };
  for (std::uint64_t place = kHeadBytes; !too_many() && read(place, head); ++chunks) {
    const std::uint64_t bytes = AV_RB32(head.data());
    if (type(4) == "tEXt" || type(4) == "zTXt" || type(4) == "iTXt") ++texts;
    if (type(4) == "zTXt" || (type(4) == "iCCP" && profiles++ > 0)) packed += bytes;  // one profile is usual
    if (type(4) == "IEND") break;
    place += kHeadBytes + bytes + kSumBytes;
  }
  return too_many();
}

}  // namespace

bool hasTooManyTexts(std::span<const std::uint8_t> picture) {
  return countsTooMany([&](std::uint64_t place, Head& head) {
    if (picture.size() < kHeadBytes || place > picture.size() - kHeadBytes) return false;
    std::ranges::copy(picture.subspan(static_cast<std::size_t>(place), kHeadBytes), head.begin());
    return true;
  });
}

bool hasTooManyTexts(const AnsweredFile& file) {
  return countsTooMany(
      [&](std::uint64_t place, Head& head) { return file.read(place, head).value_or(0) == kHeadBytes; });
}

}  // namespace relievo::ffmpeg
