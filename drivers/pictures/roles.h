// SPDX-License-Identifier: Apache-2.0
// Whether a name of a file or a folder says colour or depth.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace relievo::pictures {

enum class Role : std::uint8_t {
  Unsaid,
  Color,
  Depth,
  Other,  // a mask, a label, an infrared picture, ..
};

// By the words in `name`, which anything but letters parts; "d-12.pgm" and "r-12.ppm" are depth and colour.
[[nodiscard]] Role roleOf(std::string_view name);

// The best of the `names` with this role: the one that says that it is in the colour's view ("aligned_depth"), else the
// one that is nothing but the word, else the first in natural order. Empty if none has it.
[[nodiscard]] std::string bestOf(const std::vector<std::string>& names, Role role);

}  // namespace relievo::pictures
