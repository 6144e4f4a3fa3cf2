// SPDX-License-Identifier: Apache-2.0
#include "drivers/exr/exr_header.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>

namespace relievo::exr {
namespace {

struct FixedSize {
  std::string_view type;
  std::size_t bytes;
};
constexpr FixedSize kFixed[] = {{"box2f", 16},
                                {"box2i", 16},
                                {"chromaticities", 32},
                                {"compression", 1},
                                {"deepImageState", 1},
                                {"double", 8},
                                {"envmap", 1},
                                {"float", 4},
                                {"int", 4},
                                {"keycode", 28},
                                {"lineOrder", 1},
                                {"m33d", 72},
                                {"m33f", 36},
                                {"m44d", 128},
                                {"m44f", 64},
                                {"rational", 8},
                                {"tiledesc", 9},
                                {"timecode", 8},
                                {"v2d", 16},
                                {"v2f", 8},
                                {"v2i", 8},
                                {"v3d", 24},
                                {"v3f", 12},
                                {"v3i", 12}};

std::uint32_t number32(std::string_view bytes, std::size_t at) noexcept {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// Takes a text that ends with a zero from the beginning of `rest`.
std::optional<std::string_view> takeText(std::string_view& rest) noexcept {
  const std::size_t end = rest.find('\0');
  if (end == rest.npos) return std::nullopt;
  const std::string_view text = rest.substr(0, end);
  rest.remove_prefix(end + 1);
  return text;
}

// Names with 16 bytes each, ended by an empty name.
bool isSoundChannelList(std::string_view value) noexcept {
  constexpr std::size_t kOfChannel = 16;
  for (;;) {
    const auto name = takeText(value);
    if (!name) return false;
    if (name->empty()) return value.empty();
    if (value.size() < kOfChannel) return false;
    value.remove_prefix(kOfChannel);
  }
}

bool isSoundStringVector(std::string_view value) noexcept {
  while (!value.empty()) {
    if (value.size() < 4 || number32(value, 0) > value.size() - 4) return false;
    value.remove_prefix(4 + std::size_t{number32(value, 0)});
  }
  return true;
}

bool isSoundPreview(std::string_view value) noexcept {
  if (value.size() < 8) return false;
  const std::uint64_t width = number32(value, 0), height = number32(value, 4);
  return width < 0x10000 && height < 0x10000 && 4 * width * height == value.size() - 8;
}

bool isSound(std::string_view name, std::string_view type, std::string_view value, std::size_t file_bytes) noexcept {
  for (const FixedSize& fixed : kFixed) {
    if (type == fixed.type && value.size() != fixed.bytes) return false;
  }
  if (name == "chunkCount") return type == "int" && number32(value, 0) <= file_bytes / 8;
  if (type == "chlist") return isSoundChannelList(value);
  if (type == "stringvector") return isSoundStringVector(value);
  if (type == "preview") return isSoundPreview(value);
  return type != "idmanifest";
}

}  // namespace

bool fitsItsHeaders(std::span<const std::uint8_t> file) noexcept {
  constexpr std::uint32_t kMultipart = 0x1000;
  constexpr std::size_t kBegin = 8;
  std::string_view rest(reinterpret_cast<const char*>(file.data()), file.size());
  if (rest.size() < kBegin) return false;
  const bool multipart = (number32(rest, 4) & kMultipart) != 0;
  rest.remove_prefix(kBegin);
  for (bool begins = true;; begins = false) {
    const auto name = takeText(rest);
    if (!name) return false;
    if (name->empty()) {  // the end of a header; in a file of parts an empty one ends them all
      if (!multipart || begins) return true;
      const auto next = rest.empty() ? '\0' : rest.front();
      if (next == '\0') return true;
      continue;
    }
    const auto type = takeText(rest);
    if (!type || rest.size() < 4 || number32(rest, 0) > rest.size() - 4) return false;
    const std::size_t bytes = number32(rest, 0);
    if (!isSound(*name, *type, rest.substr(4, bytes), file.size())) return false;
    rest.remove_prefix(4 + bytes);
  }
}

}  // namespace relievo::exr
