// SPDX-License-Identifier: Apache-2.0
// Feeds liblz4, libbz2 and libzstd piece by piece.
#include "drivers/rosbag/unpack.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>

namespace relievo::rosbag {
namespace {

constexpr std::size_t kPiece = std::size_t{64} << 10;

// Calls `decode(input, room)` until it cannot go on. It takes bytes off the front of both spans and returns false at
// the end or at an error.
template <class Decode>
std::vector<std::uint8_t> unpack(const Range& packed, std::size_t plain_bytes, Decode decode) {
  std::vector<std::uint8_t> plain;
  std::array<std::uint8_t, kPiece> piece;
  std::uint64_t at = 0;
  Bytes input;
  for (bool more = true; more && plain.size() < plain_bytes;) {
    if (input.empty()) {
      input = Bytes(piece).first(packed.read(at, piece));
      at += input.size();
      if (input.empty()) break;
    }
    const std::size_t before = plain.size();
    plain.resize(std::min(plain_bytes, before + std::max(kPiece, before / 2)));
    std::span<std::uint8_t> room = std::span(plain).subspan(before);
    const std::size_t unread = input.size();
    more = decode(input, room);
    plain.resize(plain.size() - room.size());
    if (input.size() == unread && plain.size() == before) break;  // no progress: the data is damaged
  }
  return plain;
}

}  // namespace

std::vector<std::uint8_t> unpackLz4(const Range& packed, std::size_t plain_bytes) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) return {};
  auto plain = unpack(packed, plain_bytes, [&](Bytes& input, std::span<std::uint8_t>& room) {
    std::size_t written = room.size(), consumed = input.size();
    const std::size_t left = LZ4F_decompress(context, room.data(), &written, input.data(), &consumed, nullptr);
    const bool failed = LZ4F_isError(left) != 0;
    room = room.subspan(failed ? 0 : written);
    input = input.subspan(failed ? 0 : consumed);
    return !failed && left != 0;
  });
  LZ4F_freeDecompressionContext(context);
  return plain;
}

std::vector<std::uint8_t> unpackBz2(const Range& packed, std::size_t plain_bytes) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return {};
  auto plain = unpack(packed, plain_bytes, [&](Bytes& input, std::span<std::uint8_t>& room) {
    stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(input.data()));  // the library only reads it
    stream.avail_in = static_cast<unsigned>(input.size());
    stream.next_out = reinterpret_cast<char*>(room.data());
    stream.avail_out = static_cast<unsigned>(room.size());
    const int status = BZ2_bzDecompress(&stream);
    room = room.last(stream.avail_out);
    input = input.last(stream.avail_in);
    return status == BZ_OK;
  });
  BZ2_bzDecompressEnd(&stream);
  return plain;
}

std::vector<std::uint8_t> unpackZstd(const Range& packed, std::size_t plain_bytes) {
  ZSTD_DStream* const stream = ZSTD_createDStream();
  if (stream == nullptr) return {};
  auto plain = unpack(packed, plain_bytes, [&](Bytes& input, std::span<std::uint8_t>& room) {
    ZSTD_inBuffer in{input.data(), input.size(), 0};
    ZSTD_outBuffer out{room.data(), room.size(), 0};
    const std::size_t left = ZSTD_decompressStream(stream, &out, &in);
    room = room.subspan(out.pos);
    input = input.subspan(in.pos);
    return ZSTD_isError(left) == 0 && left != 0;
  });
  ZSTD_freeDStream(stream);
  return plain;
}

}  // namespace relievo::rosbag
