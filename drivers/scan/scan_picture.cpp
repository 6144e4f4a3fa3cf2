// SPDX-License-Identifier: Apache-2.0
#include "drivers/scan/scan_picture.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>

#include "platform/print.h"

namespace relievo::scan {
namespace {

void put(std::vector<std::uint8_t>& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

const char* codecOf(Coding coding) noexcept {
  switch (coding) {
    case Coding::Raw:
      return "rawvideo";
    case Coding::Deflated:
      return "tiff";
    case Coding::Jpeg:
      return "mjpeg";
    case Coding::Png:
      return "png";
  }
  return "";
}

// A TIFF 6.0 file of 16-bit gray in one strip of zlib's format (compression 8).
std::vector<std::uint8_t> tiffAround(std::span<const std::uint8_t> deflated, PictureSize size) {
  constexpr std::uint32_t kShort = 3, kLong = 4;
  constexpr int kEntries = 9;
  constexpr std::uint32_t kStrip = 8 + 2 + 12 * kEntries + 4;
  struct Entry {
    std::uint32_t tag, type, value;
  };
  const Entry entries[kEntries] = {
      {256, kLong, size.cols},                                    // ImageWidth
      {257, kLong, size.rows},                                    // ImageLength
      {258, kShort, 16},                                          // BitsPerSample
      {259, kShort, 8},                                           // Compression: Adobe deflate
      {262, kShort, 1},                                           // PhotometricInterpretation: black is zero
      {273, kLong, kStrip},                                       // StripOffsets
      {277, kShort, 1},                                           // SamplesPerPixel
      {278, kLong, size.rows},                                    // RowsPerStrip
      {279, kLong, static_cast<std::uint32_t>(deflated.size())},  // StripByteCounts
  };
  std::vector<std::uint8_t> tiff{'I', 'I', 42, 0, 8, 0, 0, 0};
  tiff.reserve(kStrip + deflated.size());
  put(tiff, kEntries, 2);
  for (const Entry& entry : entries) {
    put(tiff, entry.tag, 2);
    put(tiff, entry.type, 2);
    put(tiff, 1, 4);
    put(tiff, entry.value, 4);
  }
  put(tiff, 0, 4);
  std::ranges::copy(deflated, std::back_inserter(tiff));
  return tiff;
}

}  // namespace

std::optional<PictureSize> jpegSize(std::span<const std::uint8_t> jpeg) noexcept {
  constexpr std::uint8_t kHuffman = 0xc4, kExtension = 0xc8,
                         kArithmetic = 0xcc;  // the markers c0 to cf that are no SOF
  constexpr std::size_t kSizeEnd = 9;
  if (jpeg.size() < 4 || jpeg[0] != 0xff || jpeg[1] != 0xd8) return std::nullopt;
  std::size_t at = 2;
  while (at + kSizeEnd <= jpeg.size() && jpeg[at] == 0xff) {
    const std::uint8_t marker = jpeg[at + 1];
    const auto pair = [&](std::size_t i) { return std::uint32_t{jpeg[at + i]} << 8 | jpeg[at + i + 1]; };
    const bool frame = (marker & 0xf0) == 0xc0 && marker != kHuffman && marker != kExtension && marker != kArithmetic;
    if (frame) return PictureSize{pair(7), pair(5)};
    at += 2 + pair(2);
  }
  return std::nullopt;
}

std::optional<std::vector<std::uint8_t>> readPlace(const AnsweredFile& file, const Place& place) {
  std::vector<std::uint8_t> bytes(std::min(place.bytes, kMostPicture));
  if (bytes.empty() || file.read(place.begin, bytes).value_or(0) != bytes.size()) return std::nullopt;
  return bytes;
}

void describePictures(const Scan& scan, bool depth, StreamInfo& stream) {
  const Coding coding = depth ? scan.depth : scan.color;
  stream.kind = StreamKind::Video;
  stream.tags["TITLE"] = depth ? "depth" : "color";
  stream.codec = codecOf(coding);
  if (depth || coding == Coding::Raw) {
    stream.pixel_format = depth ? "gray16le" : "rgb24";
    stream.bits = depth ? 16 : 8;
  }
  stream.width = static_cast<int>(depth ? scan.depth_cols : scan.color_cols);
  stream.height = static_cast<int>(depth ? scan.depth_rows : scan.color_rows);
  if (depth) stream.tags.insert({{"DEPTH_UNIT", print("%.9g", 1000 / scan.codes_per_metre)}, {"DEPTH_INVALID", "0"}});
}

std::optional<Packet> packetOf(const Scan& scan, bool depth, std::vector<std::uint8_t> stored) {
  const Coding coding = depth ? scan.depth : scan.color;
  const PictureSize size{depth ? scan.depth_cols : scan.color_cols, depth ? scan.depth_rows : scan.color_rows};
  const std::size_t raw_bytes = std::size_t{size.cols} * size.rows * (depth ? 2 : 3);
  if (coding == Coding::Raw && stored.size() != raw_bytes) return std::nullopt;
  if (coding == Coding::Deflated) stored = tiffAround(stored, size);
  const auto owner = std::make_shared<const std::vector<std::uint8_t>>(std::move(stored));
  Packet packet;
  packet.data = owner->data();
  packet.bytes = owner->size();
  packet.keyframe = true;
  packet.owner = owner;
  return packet;
}

}  // namespace relievo::scan
