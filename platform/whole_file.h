// SPDX-License-Identifier: Apache-2.0
// Reads a small regular file whole; refuses folders, devices, pipes and files that are too large.
#pragma once

#include <cstdint>
#include <string>

#include "platform/error.h"

namespace relievo {

// The largest size allowed.
enum class FileSize : std::uint8_t {
  Settings,   // 1 MiB: configurations, key tables, calibrations, scripts
  Recording,  // 256 MiB: a hand's path, one line per tick
};

// NotFound, with the message `cannot_read`, if the file cannot be opened; Unsupported for a folder, a device or a
// pipe, which may never end; Exhausted for a file that is too large; Io; Timeout and Cancelled as
// platform/files/file_system_answer.h says. Never waits for a pipe or a device. Any thread. `cannot_read` must outlive
// the error.
[[nodiscard]] Result<std::string> readWholeFile(const std::string& path, FileSize size, const char* cannot_read);

}  // namespace relievo
