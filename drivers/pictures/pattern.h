// SPDX-License-Identifier: Apache-2.0
// Patterns of pictures' names: "b%06d.png", "*.png".
#pragma once

#include <string>

namespace relievo::pictures {

// Whether a file's name is a pattern of pictures' names.
[[nodiscard]] bool isPattern(const std::string& name);

// Whether `name` is one of the pattern: a number of at least as many digits as it says, or as fnmatch() has it.
[[nodiscard]] bool matches(const std::string& pattern, const std::string& name);

}  // namespace relievo::pictures
