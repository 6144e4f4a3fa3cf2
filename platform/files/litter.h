// SPDX-License-Identifier: Apache-2.0
// Temporary files and folders beside their target: their names, and the removal of those that a killed run left.
#pragma once

#include <string>

namespace relievo {

// A name for mkstemp and mkdtemp, ending in XXXXXX. Call `holdLitter` on the result to keep it from removal.
[[nodiscard]] std::string litterPattern(const std::string& target);
// Protects the file or folder `fd` from `removeLitter` until the descriptor is closed, however the process ends.
// Without locks in the file system it does nothing, and `removeLitter` removes nothing there.
void holdLitter(int fd) noexcept;
// Removes the temporary files that dead processes left beside `target`: those with a name that `litterPattern` gives,
// and folders of such names with nothing in them but a playlist and its segments.
void removeLitter(const std::string& target) noexcept;

}  // namespace relievo
