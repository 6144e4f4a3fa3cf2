// SPDX-License-Identifier: Apache-2.0
// A folder that the environment names.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace relievo {

// Empty if the variable is not set or its path is relative, which the XDG Base Directory Specification says to ignore.
[[nodiscard]] inline std::filesystem::path namedFolder(const char* variable) {
  const char* const named = std::getenv(variable);
  const std::filesystem::path folder = named == nullptr ? "" : named;
  return folder.is_absolute() ? folder : std::filesystem::path();
}

}  // namespace relievo
