// SPDX-License-Identifier: Apache-2.0
// Files and folders that are made beside their place: how they are named, and how those of a killed run are found.
#pragma once

#include <string>

namespace relievo {

// Ends in XXXXXX, for mkstemp and mkdtemp. Who makes one holds it by `holdLitter` for as long as it is needed.
[[nodiscard]] std::string litterPattern(const std::string& target);
// `fd`: of the file or folder. The hold ends with the descriptor, however the process ends. Quietly does nothing where
// the file system knows no locks: then nobody removes it.
void holdLitter(int fd) noexcept;
// Removes what runs that are gone have left beside `target`.
void removeLitter(const std::string& target) noexcept;

}  // namespace relievo
