// SPDX-License-Identifier: Apache-2.0
// Changes timestamps in a Matroska file, as programs do that cut films together without care.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace relievo::test {

// Moves the clusters that begin at or after `from_ms` back by `by_ms`; returns how many they are.
inline int moveClustersBack(const std::string& path, std::uint64_t from_ms, std::uint64_t by_ms) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  const auto byteAt = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes.at(i)); };
  int moved = 0;
  constexpr char kCluster[] = "\x1f\x43\xb6\x75";
  for (std::size_t at = bytes.find(kCluster); at != std::string::npos; at = bytes.find(kCluster, at + 4)) {
    std::size_t length = 1;  // of the cluster's size
    while (length < 8 && (byteAt(at + 4) & (0x80u >> (length - 1))) == 0) ++length;
    std::size_t element = at + 4 + length;
    if (byteAt(element) == 0xbf) element += 6;  // a checksum of four bytes
    if (byteAt(element) != 0xe7) continue;      // the cluster's timestamp
    const std::size_t size = byteAt(element + 1) & 0x7fu;
    std::uint64_t ms = 0;
    for (std::size_t i = 0; i < size; ++i) ms = ms << 8 | byteAt(element + 2 + i);
    if (ms < from_ms) continue;
    ms -= by_ms;
    for (std::size_t i = size; i-- > 0; ms >>= 8) bytes[element + 2 + i] = static_cast<char>(ms & 0xff);
    ++moved;
  }
  std::ofstream(path, std::ios::binary) << bytes;
  return moved;
}

}  // namespace relievo::test
