// SPDX-License-Identifier: Apache-2.0
// Damage to files, as disks, networks and other programs do it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>

namespace relievo::test {

// Bits flipped, bytes overwritten, pieces removed, doubled or moved, the end cut off; more often in the head of the
// file, which holds sizes and tables.
inline std::string damaged(std::string bytes, std::mt19937& random) {
  const auto place = [&random](std::size_t size) {
    const std::size_t reach = random() % 2 == 0 ? std::min<std::size_t>(size, 1024) : size;
    return random() % std::max<std::size_t>(reach, 1);
  };
  for (auto times = 1 + random() % 12; times > 0 && !bytes.empty(); --times) {
    const std::size_t at = place(bytes.size());
    const std::size_t length = std::min<std::size_t>(1 + random() % 64, bytes.size() - at);
    switch (random() % 6) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        break;
      case 1:
        for (std::size_t i = 0; i < length; ++i) bytes[at + i] = static_cast<char>(random());
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 4:
        std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length,
                    static_cast<char>(random() % 2 == 0 ? 0 : 255));
        break;
      default:
        if (random() % 4 == 0) bytes.resize(place(bytes.size()));
    }
  }
  return bytes;
}

}  // namespace relievo::test
