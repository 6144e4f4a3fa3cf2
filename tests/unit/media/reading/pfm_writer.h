// SPDX-License-Identifier: Apache-2.0
// Portable float maps, as other programs write them: rows from the bottom up, a negative scale for little endian.
#pragma once

#include <fstream>
#include <string>

namespace relievo::test {

// `sample(c, r)`: of row r from the top.
template <class Sample>
void writePfm(const std::string& path, int cols, int rows, Sample&& sample) {
  std::ofstream file(path, std::ios::binary);
  file << "Pf\n" << cols << ' ' << rows << "\n-1\n";
  for (int r = rows - 1; r >= 0; --r) {
    for (int c = 0; c < cols; ++c) {
      const auto value = static_cast<float>(sample(c, r));
      file.write(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
}

}  // namespace relievo::test
