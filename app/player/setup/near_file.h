// SPDX-License-Identifier: Apache-2.0
// What a misspelt file was meant to be.
#pragma once

#include <string>

namespace relievo {

// The file or folder beside `path` that has nearly its name, or its name with another extension; empty if there is
// none. May wait for the disk.
[[nodiscard]] std::string nearFile(const std::string& path);

}  // namespace relievo
