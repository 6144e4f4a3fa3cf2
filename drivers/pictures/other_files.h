// SPDX-License-Identifier: Apache-2.0
// Files that are no pictures but hold depth: how a folder of them is converted.
#pragma once

#include <string>
#include <string_view>

namespace relievo::pictures {

// One line for a user, FOLDER being the folder's name; null for a name of no such file. Of a .mat file in `folder`
// the head is read.
[[nodiscard]] const char* wayToConvert(const std::string& folder, std::string_view name);

}  // namespace relievo::pictures
