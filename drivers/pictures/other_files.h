// SPDX-License-Identifier: Apache-2.0
// Files that are no pictures but hold depth: how a folder of them is converted.
#pragma once

#include <string_view>

namespace relievo::pictures {

// One line for a user, FOLDER being the folder's name; null for a name of no such file.
[[nodiscard]] const char* wayToConvert(std::string_view name);

}  // namespace relievo::pictures
