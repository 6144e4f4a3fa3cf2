// SPDX-License-Identifier: Apache-2.0
// Patterns of pictures' names: "b%06d.png", "*.png".
#pragma once

#include <string>

#include "drivers/pictures/folder.h"

namespace relievo::pictures {

// Whether a file's name is a pattern of pictures' names.
[[nodiscard]] bool isPattern(const std::string& name);

// Whether `name` is one of the pattern: a number of at least as many digits as it says, or as fnmatch() has it.
[[nodiscard]] bool matches(const std::string& pattern, const std::string& name);

// The pictures of `folder` that match; NotFound if none does.
[[nodiscard]] Result<FoundPictures> findByPattern(const std::string& folder, const std::string& pattern);

}  // namespace relievo::pictures
