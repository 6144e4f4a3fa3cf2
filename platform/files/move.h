// SPDX-License-Identifier: Apache-2.0
// Moves of files and folders within a file system, also where it knows no flags of renameat2, as NFS and sshfs do not.
#pragma once

#include <string>

namespace relievo {

// Moves `from` to a name that is free. 0 or errno; EEXIST if something is there, which stays. Without the flag, a
// program that is killed in between may leave an empty folder of that name, or, without links either, an empty file.
[[nodiscard]] int moveToNew(const std::string& from, const std::string& to) noexcept;
// Exchanges two files or folders. 0 or errno; then both are where they were. Without the flag, `to` is missing for a
// moment: it is called TO.relievo-old, and a program that is killed then leaves it there.
[[nodiscard]] int exchange(const std::string& from, const std::string& to);

}  // namespace relievo
