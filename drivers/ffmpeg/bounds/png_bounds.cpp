// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/bounds/png_bounds.h"

#include <zlib.h>

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
constexpr std::size_t kLongestName = 79;  // of a text or a profile; a 0 and the method follow
using Head = std::array<std::uint8_t, kHeadBytes>;

// How long a stream of zlib becomes, until it ends, is damaged, or is longer than `most`.
std::uint64_t unpackedBytes(const Readable& picture, std::uint64_t place, std::uint64_t end, std::uint64_t most) {
  constexpr std::size_t kPiece = 16384;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return 0;  // no memory
  std::array<std::uint8_t, kPiece> packed{}, unpacked{};
  std::uint64_t bytes = 0;
  for (int status = Z_OK; status == Z_OK && bytes <= most;) {
    if (stream.avail_in == 0) {
      const std::size_t rest = static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, end - place));
      stream.next_in = packed.data();
      stream.avail_in = static_cast<uInt>(picture(place, std::span(packed).first(rest)));
      place += stream.avail_in;
    }
    stream.next_out = unpacked.data();
    stream.avail_out = kPiece;
    status = inflate(&stream, Z_NO_FLUSH);  // Z_BUF_ERROR: the chunk ends before the stream does
    bytes += kPiece - stream.avail_out;
  }
  inflateEnd(&stream);
  return bytes;
}

// Of a text or a profile: its name, a 0, the method, and a stream of zlib.
std::uint64_t unpackedChunk(const Readable& picture, std::uint64_t place, std::uint64_t end) {
  std::array<std::uint8_t, kLongestName + 1> name{};
  const std::size_t read = picture(place, name);
  const auto last = std::find(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(read), 0);
  const std::uint64_t stream = place + static_cast<std::uint64_t>(last - name.begin()) + 2;
  if (stream >= end) return 0;
  if (last == name.end()) return kMostUnpackedBytes + 1;  // no such name; FFmpeg unpacks some of those
  return unpackedBytes(picture, stream, end, kMostUnpackedBytes);
}

}  // namespace

const char* exceededPngBound(const Readable& picture) {
  Head head{};
  const auto read = [&](std::uint64_t place) { return picture(place, head) == kHeadBytes; };
  const auto type = [&head](std::size_t from) {
    return std::string_view(reinterpret_cast<const char*>(head.data()) + from, kHeadBytes - from);
  };
  if (!read(0) || type(0) != "\x89PNG\r\n\x1a\n"sv) return nullptr;
  int texts = 0, chunks = 0;
  std::uint64_t unpacked = 0;
  const auto exceeded = [&] { return texts > kMostTexts || chunks > kMostChunks || unpacked > kMostUnpackedBytes; };
  for (std::uint64_t place = kHeadBytes; !exceeded() && read(place); ++chunks) {
    const std::uint64_t data = place + kHeadBytes, end = data + AV_RB32(head.data());
    const bool packed = type(4) == "zTXt" || type(4) == "iCCP";
    if (packed || type(4) == "tEXt" || type(4) == "iTXt") ++texts;
    if (packed) unpacked += unpackedChunk(picture, data, end);
    if (type(4) == "IEND") break;
    place = end + kSumBytes;
  }
  return exceeded() ? kTooMuchPng : nullptr;
}

}  // namespace relievo::ffmpeg
