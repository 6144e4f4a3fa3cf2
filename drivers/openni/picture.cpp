// SPDX-License-Identifier: Apache-2.0
#include "drivers/openni/picture.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "drivers/openni/depth_codec.h"

namespace relievo::openni {
namespace {

// Numbers of OniPixelFormat and XnPixelFormat.
constexpr std::uint64_t kTenthsOfMm = 101, kShifts2 = 102, kShifts3 = 103;
struct Format {
  std::uint64_t number, old_number;  // 0: has none
  const char* name;                  // FFmpeg's
  std::uint32_t pixel_bytes;
};
constexpr std::array<Format, 5> kColorFormats{{{200, 1, "rgb24", 3},
                                               {201, 2, "uyvy422", 2},
                                               {202, 3, "gray", 1},
                                               {203, 4, "gray16le", 2},
                                               {205, 0, "yuyv422", 2}}};
constexpr Format kDepthFormat{100, 4, "gray16le", 2}, kJpegFormat{204, 5, "", 0};

bool isOf(const Node& node, const Format& format) noexcept {
  if (node.format != 0) return node.format == format.number;
  return node.old_format != 0 && node.old_format == format.old_number;
}

// Null if pictures of this kind are not raw, or not known.
const Format* formatOf(const Node& node) noexcept {
  if (node.kind == NodeKind::Depth) return &kDepthFormat;
  if (node.codec != "NONE") return nullptr;
  const auto found = std::ranges::find_if(kColorFormats, [&](const Format& format) { return isOf(node, format); });
  return found == kColorFormats.end() ? nullptr : &*found;
}

bool isJpeg(const Node& node) noexcept {
  return node.codec == "JPEG" || (node.codec == "NONE" && isOf(node, kJpegFormat));
}

Packet packetOver(std::vector<std::uint8_t> bytes, std::size_t count) {
  auto owner = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  Packet packet;
  packet.data = owner->data();
  packet.bytes = count;
  packet.keyframe = true;
  packet.owner = std::move(owner);
  return packet;
}

}  // namespace

bool isReadable(const Node& node) noexcept {
  const Format* const format = formatOf(node);
  const std::uint64_t samples = std::uint64_t{node.cols} * node.rows;
  if (samples == 0 || samples > kMostPicture || samples * (format != nullptr ? format->pixel_bytes : 1) > kMostPicture)
    return false;
  if (node.kind != NodeKind::Depth) return isJpeg(node) || format != nullptr;
  return node.codec == "16zT" || node.codec == "16zP" || node.codec == "NONE";
}

std::optional<Error> refusalOf(const Node& depth) noexcept {
  if (depth.format == kShifts2 || depth.format == kShifts3) {
    return Error{ErrorCode::Unsupported, 0,
                 "the recording's depth is the sensor's raw shifts; record it in the format of 1 mm"};
  }
  if (depth.cropped) return Error{ErrorCode::Unsupported, 0, "the recording's depth is cropped; record it whole"};
  if (isReadable(depth)) return std::nullopt;
  return Error{ErrorCode::Unsupported, 0,
               "the recording's depth is packed in a way that is not known; record it by OpenNI 2"};
}

void describePictures(const Node& node, StreamInfo& stream) {
  const bool depth = node.kind == NodeKind::Depth;
  stream.tags["TITLE"] = depth ? "depth" : node.kind == NodeKind::Color ? "color" : "infrared";
  if (!isReadable(node)) return;
  const Format* const format = formatOf(node);
  stream.codec = format != nullptr ? "rawvideo" : "mjpeg";
  if (format != nullptr) {
    stream.pixel_format = format->name;
    stream.bits = format->name == std::string_view("gray16le") ? 16 : 8;
  }
  stream.width = static_cast<int>(node.cols);
  stream.height = static_cast<int>(node.rows);
  if (depth) stream.tags.insert({{"DEPTH_UNIT", node.format == kTenthsOfMm ? "0.1" : "1"}, {"DEPTH_INVALID", "0"}});
}

std::optional<Packet> packetOf(const Node& node, std::vector<std::uint8_t> stored) {
  const Format* const format = formatOf(node);
  if (format == nullptr) {
    const bool begins = stored.size() > 2 && stored[0] == 0xff && stored[1] == 0xd8;
    const std::size_t bytes = stored.size();
    return begins ? std::optional(packetOver(std::move(stored), bytes)) : std::nullopt;
  }
  const std::size_t samples = std::size_t{node.cols} * node.rows, bytes = samples * format->pixel_bytes;
  if (node.codec == "NONE") {  // OpenNI 2 may leave room behind it
    return stored.size() >= bytes ? std::optional(packetOver(std::move(stored), bytes)) : std::nullopt;
  }
  std::vector<std::uint16_t> depth(samples);
  const auto unpacks = node.codec == "16zT" ? unpack16zTable : unpack16z;
  if (!unpacks(stored, depth)) return std::nullopt;
  std::vector<std::uint8_t> plain(bytes);
  std::memcpy(plain.data(), depth.data(), bytes);
  return packetOver(std::move(plain), bytes);
}

}  // namespace relievo::openni
