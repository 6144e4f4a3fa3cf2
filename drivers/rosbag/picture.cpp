// SPDX-License-Identifier: Apache-2.0
// Translates ROS's names of encodings.
#include "drivers/rosbag/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace relievo::rosbag {
namespace {

struct Encoding {
  std::string_view name, pixel_format;
  std::uint8_t pixel_bytes, sample_bytes;
  bool color;
};
constexpr std::array<Encoding, 25> kEncodings{{
    {"mono8", "gray", 1, 1, false},
    {"8UC1", "gray", 1, 1, false},
    {"mono16", "gray16le", 2, 2, false},
    {"16UC1", "gray16le", 2, 2, false},
    {"16SC1", "gray16le", 2, 2, false},
    {"32FC1", "grayf32le", 4, 4, false},
    {"rgb8", "rgb24", 3, 1, true},
    {"8UC3", "bgr24", 3, 1, true},
    {"bgr8", "bgr24", 3, 1, true},
    {"rgba8", "rgba", 4, 1, true},
    {"bgra8", "bgra", 4, 1, true},
    {"8UC4", "bgra", 4, 1, true},
    {"rgb16", "rgb48le", 6, 2, true},
    {"bgr16", "bgr48le", 6, 2, true},
    {"yuv422", "uyvy422", 2, 1, true},
    {"UYVY", "uyvy422", 2, 1, true},
    {"uyvy", "uyvy422", 2, 1, true},
    {"yuv422_yuy2", "yuyv422", 2, 1, true},
    {"yuyv", "yuyv422", 2, 1, true},
    {"YUYV", "yuyv422", 2, 1, true},
    {"bayer_rggb8", "bayer_rggb8", 1, 1, true},
    {"bayer_bggr8", "bayer_bggr8", 1, 1, true},
    {"bayer_gbrg8", "bayer_gbrg8", 1, 1, true},
    {"bayer_grbg8", "bayer_grbg8", 1, 1, true},
    {"Y8", "gray", 1, 1, false},
}};

constexpr std::size_t kDepthHeader = 12;  // compressed_depth_image_transport: a format, and two floats
constexpr const char* kMetres = "1000";   // mm for a value of 1

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != text.npos;
}

bool beginsWith(Bytes data, std::initializer_list<std::uint8_t> magic) {
  return data.size() >= magic.size() && std::equal(magic.begin(), magic.end(), data.begin());
}

std::optional<PictureKind> rawKind(const PictureMessage& picture) {
  const auto found = std::ranges::find(kEncodings, picture.encoding, &Encoding::name);
  const std::uint64_t samples = std::uint64_t{picture.cols} * picture.rows;
  if (found == kEncodings.end() || samples == 0 || samples > std::uint64_t{1} << 30) return std::nullopt;
  PictureKind kind{.codec = "rawvideo",
                   .pixel_format = std::string(found->pixel_format),
                   .cols = picture.cols,
                   .rows = picture.rows,
                   .pixel_bytes = found->pixel_bytes,
                   .sample_bytes = found->sample_bytes,
                   .color = found->color,
                   .tags = {}};
  kind.distances = !kind.color && kind.sample_bytes > 1;
  if (kind.sample_bytes == 4) kind.tags = {{"DEPTH_UNIT", kMetres}, {"DEPTH_INVALID", "0"}};
  return kind;
}

// Inverse depth in whole numbers: 1/Z = (code - B) / A, with A and B in front of the picture; code 0 is a hole.
std::map<std::string, std::string> inverseDepthTags(Bytes header) {
  ByteReader reader(header);
  static_cast<void>(reader.value<std::uint32_t>());
  const auto a = reader.value<float>(), b = reader.value<float>();
  constexpr double kHighest = 0xffff, kMmPerMetre = 1000;
  const double lowest = std::max(1.0, std::ceil(static_cast<double>(b) + 1e-3));
  const double far = static_cast<double>(a) / (lowest - static_cast<double>(b));
  const double near = static_cast<double>(a) / (kHighest - static_cast<double>(b));
  if (!(near > 0) || !(far > near) || !std::isfinite(far) || lowest >= kHighest) return {};
  return {{"DEPTH_LAW", "inverse"},
          {"DEPTH_POLARITY", "near-high"},
          {"DEPTH_CODES", std::to_string(static_cast<int>(lowest)) + "-65535"},
          {"DEPTH_INVALID", "0"},
          {"DEPTH_NEAR", std::to_string(near * kMmPerMetre)},
          {"DEPTH_FAR", std::to_string(far * kMmPerMetre)}};
}

std::optional<PictureKind> codedKind(const PictureMessage& picture, Bytes data) {
  PictureKind kind{.codec = {}, .pixel_format = {}, .tags = {}};
  const bool depth = has(picture.encoding, "compressedDepth");
  if (depth && data.size() > kDepthHeader) kind.skipped_bytes = kDepthHeader;
  const Bytes coded = data.subspan(kind.skipped_bytes);
  if (beginsWith(coded, {0xff, 0xd8})) kind.codec = "mjpeg";
  if (beginsWith(coded, {0x89, 'P', 'N', 'G'})) kind.codec = "png";
  if (kind.codec.empty()) return std::nullopt;
  constexpr std::size_t kPngDepth = 24;  // where a PNG says the bits of a component, then whether it has colour
  const bool png = kind.codec == "png" && coded.size() > kPngDepth + 1;
  kind.color = !png || (coded[kPngDepth + 1] & 2) != 0;
  kind.distances = png && coded[kPngDepth] == 16 && !kind.color;
  if (depth && has(picture.encoding, "32FC1")) kind.tags = inverseDepthTags(data.first(kind.skipped_bytes));
  return kind;
}

void reverseSamples(std::uint8_t* samples, std::size_t bytes, std::size_t sample_bytes) {
  for (std::size_t i = 0; i + sample_bytes <= bytes; i += sample_bytes) {
    std::reverse(samples + i, samples + i + sample_bytes);
  }
}

}  // namespace

std::optional<PictureKind> kindOf(const PictureMessage& picture, Bytes message) {
  if (!picture.compressed) return rawKind(picture);
  return codedKind(picture, message.subspan(picture.data_begin, picture.data_bytes));
}

std::optional<Packet> packetOf(const PictureKind& kind, const PictureMessage& picture,
                               std::vector<std::uint8_t> message) {
  std::uint8_t* const data = message.data() + picture.data_begin;
  std::size_t bytes = picture.data_bytes;
  if (picture.compressed) {
    if (bytes <= kind.skipped_bytes) return std::nullopt;
    bytes -= kind.skipped_bytes;
  } else {
    if (picture.cols != kind.cols || picture.rows != kind.rows) return std::nullopt;
    const std::size_t row = std::size_t{kind.cols} * kind.pixel_bytes, step = picture.step_bytes;
    if (step < row || step > bytes || bytes - row < std::uint64_t{step} * (kind.rows - 1)) return std::nullopt;
    for (std::size_t r = 1; r < kind.rows && step > row; ++r) std::memmove(data + r * row, data + r * step, row);
    bytes = row * kind.rows;
    if (picture.big_endian && kind.sample_bytes > 1) reverseSamples(data, bytes, kind.sample_bytes);
  }
  auto owner = std::make_shared<const std::vector<std::uint8_t>>(std::move(message));
  Packet packet;
  packet.data = owner->data() + picture.data_begin + kind.skipped_bytes;
  packet.bytes = bytes;
  packet.keyframe = true;
  packet.owner = std::move(owner);
  return packet;
}

}  // namespace relievo::rosbag
