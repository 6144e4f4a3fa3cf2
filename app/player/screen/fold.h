// SPDX-License-Identifier: Apache-2.0
// Breaks long texts into short lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace relievo {

// Lines of at most `cells` cells (a letter of Chinese or Japanese takes two), broken at a space, dash, dot or
// underscore if one is near. Text that does not fit is left out in the middle of the last line.
[[nodiscard]] std::vector<std::string> folded(std::string_view text, int cells, std::size_t most_lines);

}  // namespace relievo
