// SPDX-License-Identifier: Apache-2.0
// Finds the file or the address that a misspelt name probably means.
#pragma once

#include <string>

namespace relievo {

// The file or folder beside `path` with a similar name, or the same name with another extension; for "www.HOST/.." the
// address; empty if there is none. May wait for the disk.
[[nodiscard]] std::string nearFile(const std::string& path);

}  // namespace relievo
