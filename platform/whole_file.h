// SPDX-License-Identifier: Apache-2.0
// Reads a small file whole, and nothing else: what has no end, or is no file, is refused.
#pragma once

#include <cstdint>
#include <string>

#include "platform/error.h"

namespace relievo {

// How large a file may be.
enum class FileSize : std::uint8_t {
  Settings,   // 1 MiB: configurations, key tables, calibrations, scripts
  Recording,  // 256 MiB: a hand's path, a tick a line
};

// NotFound with `cannot_read` where the file cannot be opened; Unsupported for a folder, a device or a pipe, which
// may never end; Exhausted for a file that is too large; Io. Never waits for what is no file. Any thread.
// `cannot_read` outlives the error.
[[nodiscard]] Result<std::string> readWholeFile(const std::string& path, FileSize size, const char* cannot_read);

}  // namespace relievo
