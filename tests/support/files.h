// SPDX-License-Identifier: Apache-2.0
// Whole files, read and written.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace relievo::test {

// Empty if there is none.
inline std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

}  // namespace relievo::test
