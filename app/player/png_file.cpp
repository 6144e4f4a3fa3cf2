// SPDX-License-Identifier: Apache-2.0
// Three chunks; the samples in stored blocks of RFC 1950 and 1951.
#include "app/player/png_file.h"

#include <algorithm>
#include <array>

#include "app/player/file_writer.h"

namespace relievo {
namespace {

constexpr std::size_t kMostStored = 65535;  // bytes of a block

void addWord(std::string& out, std::uint32_t word) {
  for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(word >> shift & 0xff);
}

std::uint32_t crcOf(std::string_view bytes) noexcept {
  std::uint32_t sum = 0xffffffff;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ ((sum & 1) != 0 ? 0xedb88320 : 0);
  }
  return ~sum;
}

void addChunk(std::string& out, std::string_view kind, std::string_view content) {
  addWord(out, static_cast<std::uint32_t>(content.size()));
  const std::size_t from = out.size();
  out.append(kind).append(content);
  addWord(out, crcOf(std::string_view(out).substr(from)));
}

std::uint32_t adlerOf(std::string_view bytes) noexcept {
  constexpr std::uint32_t kPrime = 65521;
  std::uint32_t a = 1, b = 0;
  for (const char byte : bytes) {
    a = (a + static_cast<unsigned char>(byte)) % kPrime;
    b = (b + a) % kPrime;
  }
  return b << 16 | a;
}

std::string stored(std::string_view bytes) {
  std::string out("\x78\x01", 2);
  const std::uint32_t sum = adlerOf(bytes);
  do {
    const std::size_t count = std::min(bytes.size(), kMostStored);
    out += static_cast<char>(count == bytes.size() ? 1 : 0);  // the last one
    for (const std::size_t word : {count, ~count}) {
      out += static_cast<char>(word & 0xff);
      out += static_cast<char>(word >> 8 & 0xff);
    }
    out.append(bytes.substr(0, count));
    bytes.remove_prefix(count);
  } while (!bytes.empty());
  addWord(out, sum);
  return out;
}

}  // namespace

Result<void> writePng(const std::string& path, int width, int height, std::span<const std::uint8_t> rgb) {
  std::string rows;
  const auto row_bytes = static_cast<std::size_t>(width) * 3;
  for (std::size_t at = 0; at + row_bytes <= rgb.size(); at += row_bytes) {
    rows += '\0';  // no filter
    rows.append(reinterpret_cast<const char*>(rgb.data()) + at, row_bytes);
  }
  std::string head;
  addWord(head, static_cast<std::uint32_t>(width));
  addWord(head, static_cast<std::uint32_t>(height));
  head.append("\x08\x02\x00\x00\x00", 5);  // 8 bits, red green blue
  std::string file("\x89PNG\r\n\x1a\n", 8);
  addChunk(file, "IHDR", head);
  addChunk(file, "IDAT", stored(rows));
  addChunk(file, "IEND", "");
  return writeFile(path, file, Existing::Keep);
}

}  // namespace relievo
