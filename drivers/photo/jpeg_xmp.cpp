// SPDX-License-Identifier: Apache-2.0
#include "drivers/photo/jpeg_xmp.h"

#include <algorithm>
#include <cctype>

namespace relievo::photo {
namespace {

constexpr std::uint8_t kApp1 = 0xe1;
constexpr std::string_view kStandard("http://ns.adobe.com/xap/1.0/\0", 29);
constexpr std::string_view kExtended("http://ns.adobe.com/xmp/extension/\0", 35);
constexpr std::string_view kExif("Exif\0\0", 6);
constexpr std::size_t kOrientation = 0x112;  // TIFF 6.0
constexpr std::size_t kGuid = 32;
constexpr std::size_t kMostExtended = std::size_t{256} << 20;

std::size_t number32(std::string_view bytes) noexcept {
  std::size_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[static_cast<std::size_t>(i)]);
  return value;
}

// Puts a part of the extended packet in its place. The file holds every byte of it, so it is no larger than the file.
void place(std::string_view part, std::string& extended, std::size_t file_bytes) {
  if (part.size() < kGuid + 8) return;
  const std::size_t whole = number32(part.substr(kGuid)), offset = number32(part.substr(kGuid + 4));
  part.remove_prefix(kGuid + 8);
  if (whole > std::min(kMostExtended, file_bytes) || offset > whole || part.size() > whole - offset) return;
  if (extended.size() < whole) extended.resize(whole, ' ');
  std::copy(part.begin(), part.end(), extended.begin() + static_cast<std::ptrdiff_t>(offset));
}

// Of EXIF's orientations that do not mirror.
int quarterTurns(std::size_t orientation) noexcept {
  return orientation == 6 ? 1 : orientation == 3 ? 2 : orientation == 8 ? 3 : 0;
}

bool isNameEnd(std::string_view text, std::size_t at) noexcept {
  return at < text.size() && std::string_view(" =>\t\r\n/").find(text[at]) != std::string_view::npos;
}

std::optional<std::string_view> valueAt(std::string_view rest, bool element) {
  if (element) {
    const std::size_t begin = rest.find('>');
    if (begin == rest.npos || (begin > 0 && rest[begin - 1] == '/')) return std::nullopt;
    const std::size_t end = rest.find('<', begin);
    return end == rest.npos ? std::nullopt : std::optional(rest.substr(begin + 1, end - begin - 1));
  }
  const std::size_t quote = rest.find_first_not_of("= \t\r\n");
  if (quote == rest.npos || (rest[quote] != '"' && rest[quote] != '\'')) return std::nullopt;
  const std::size_t end = rest.find(rest[quote], quote + 1);
  return end == rest.npos ? std::nullopt : std::optional(rest.substr(quote + 1, end - quote - 1));
}

}  // namespace

std::vector<std::string_view> segmentsOf(std::span<const std::uint8_t> jpeg, std::uint8_t marker) {
  constexpr std::uint8_t kStartOfScan = 0xda, kFill = 0xff;
  const std::string_view bytes(reinterpret_cast<const char*>(jpeg.data()), jpeg.size());
  std::vector<std::string_view> segments;
  if (!bytes.starts_with("\xff\xd8")) return segments;
  std::size_t at = 2;
  while (at + 4 <= jpeg.size() && jpeg[at] == 0xff && jpeg[at + 1] != kStartOfScan) {
    if (jpeg[at + 1] == kFill) {
      ++at;
      continue;
    }
    const std::size_t length = std::size_t{jpeg[at + 2]} << 8 | jpeg[at + 3];  // with these two bytes
    if (length < 2 || at + 2 + length > jpeg.size()) break;
    if (jpeg[at + 1] == marker) segments.push_back(bytes.substr(at + 4, length - 2));
    at += 2 + length;
  }
  return segments;
}

std::string xmpOf(std::span<const std::uint8_t> jpeg) {
  std::string standard, extended;
  for (const std::string_view segment : segmentsOf(jpeg, kApp1)) {
    if (segment.starts_with(kStandard)) standard += segment.substr(kStandard.size());
    if (segment.starts_with(kExtended)) place(segment.substr(kExtended.size()), extended, jpeg.size());
  }
  return standard + extended;
}

std::optional<int> exifRotation(std::span<const std::uint8_t> jpeg) {
  for (std::string_view exif : segmentsOf(jpeg, kApp1)) {
    if (!exif.starts_with(kExif)) continue;
    exif.remove_prefix(kExif.size());
    if (exif.size() < 8) continue;
    const bool high_first = exif.starts_with("MM");
    const auto number = [&](std::size_t at, std::size_t bytes) {
      std::size_t value = 0;
      for (std::size_t i = 0; at + bytes <= exif.size() && i < bytes; ++i) {
        value = value << 8 | static_cast<std::uint8_t>(exif[high_first ? at + i : at + bytes - 1 - i]);
      }
      return value;
    };
    const std::size_t directory = number(4, 4), entries = number(directory, 2);
    for (std::size_t i = 0; i < entries && directory + 2 + 12 * (i + 1) <= exif.size(); ++i) {
      const std::size_t entry = directory + 2 + 12 * i;
      if (number(entry, 2) == kOrientation) return quarterTurns(number(entry + 8, 2));
    }
  }
  return std::nullopt;
}

std::optional<std::string_view> property(std::string_view xmp, std::string_view name) {
  // Each look for a value may go to the end of the text.
  constexpr int kMostLooks = 16;
  int looks = 0;
  for (std::size_t at = xmp.find(name); at != xmp.npos; at = xmp.find(name, at + name.size())) {
    const char before = at == 0 ? ' ' : xmp[at - 1];
    const bool element = before == '<';
    if (!element && std::isspace(static_cast<unsigned char>(before)) == 0) continue;
    if (!isNameEnd(xmp, at + name.size())) continue;
    if (++looks > kMostLooks) break;
    if (const auto value = valueAt(xmp.substr(at + name.size()), element)) return value;
  }
  return std::nullopt;
}

std::optional<std::vector<std::uint8_t>> fromBase64(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (std::isspace(static_cast<unsigned char>(c)) != 0) continue;
    if (c == '=') break;
    const std::size_t digit = kDigits.find(c);
    if (digit == kDigits.npos) return std::nullopt;
    word = (word << 6 | static_cast<std::uint32_t>(digit)) & 0xffffff;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(word >> bits & 0xff));
  }
  return bytes;
}

}  // namespace relievo::photo
