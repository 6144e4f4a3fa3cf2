// SPDX-License-Identifier: Apache-2.0
// Long texts in short lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace relievo {

// In lines of at most so many cells (a letter of Chinese or Japanese takes two), broken at spaces, dashes, dots and
// underscores if one is near; what does not find room is left out in the middle of the last line.
[[nodiscard]] std::vector<std::string> folded(std::string_view text, int cells, std::size_t most_lines);

}  // namespace relievo
