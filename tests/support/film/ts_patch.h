// SPDX-License-Identifier: Apache-2.0
// Changes what a transport stream's tables say, as a muxer of another make would have written them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>

namespace relievo::test {

// ISO/IEC 13818-1, annex A.
[[nodiscard]] inline std::uint32_t mpegCrc(const std::string& bytes, std::size_t from, std::size_t to) {
  std::uint32_t crc = 0xffffffff;
  for (std::size_t i = from; i < to; ++i) {
    crc ^= static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes[i])) << 24;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x80000000) != 0 ? 0x04c11db7 : 0);
  }
  return crc;
}

// Gives the `index`-th stream of every programme map of a file the stream type 0x1E: auxiliary video (ISO/IEC 23002-3).
// Returns how many maps there were. Each must lie in one packet.
inline int signalAsDepth(const std::string& ts_path, int index) {
  constexpr std::size_t kPacket = 188;
  std::ifstream in(ts_path, std::ios::binary);
  std::string ts(std::istreambuf_iterator<char>(in), {});
  in.close();
  const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<std::uint8_t>(ts[at])); };
  const auto word = [&](std::size_t at) { return byte(at) << 8 | byte(at + 1); };
  std::size_t map_pid = 0x2000;
  int maps = 0;
  for (std::size_t packet = 0; packet + kPacket <= ts.size(); packet += kPacket) {
    const std::size_t pid = word(packet + 1) & 0x1fff;
    const bool begins = (byte(packet + 1) & 0x40) != 0;
    if (!begins || (pid != 0 && pid != map_pid)) continue;
    const std::size_t payload = packet + 4 + ((byte(packet + 3) & 0x20) != 0 ? 1 + byte(packet + 4) : 0);
    const std::size_t section = payload + 1 + byte(payload);  // past the pointer field
    const std::size_t crc_at = section + 3 + (word(section + 1) & 0xfff) - 4;
    if (pid == 0) {
      map_pid = word(section + 10) & 0x1fff;  // of the first programme
      continue;
    }
    std::size_t stream = section + 12 + (word(section + 10) & 0xfff);
    for (int i = 0; i < index; ++i) stream += 5 + (word(stream + 3) & 0xfff);
    ts[stream] = 0x1e;
    const std::uint32_t crc = mpegCrc(ts, section, crc_at);
    for (int i = 0; i < 4; ++i) ts[crc_at + static_cast<std::size_t>(i)] = static_cast<char>(crc >> (24 - 8 * i));
    ++maps;
  }
  std::ofstream(ts_path, std::ios::binary) << ts;
  return maps;
}

}  // namespace relievo::test
