// SPDX-License-Identifier: Apache-2.0
// Refuses an output that would overwrite an input.
#pragma once

#include <string>
#include <vector>

#include "platform/failure.h"

namespace relievo {

// The existing files that opening `address` reads: the file itself (also as a `file:` address), the pictures of a
// numbered sequence (`%04d`), and everything that a playlist names, nested lists included. Empty if it is not a file.
// Bounded: lists of up to 1 MiB, four levels, 10,000 files.
[[nodiscard]] std::vector<std::string> filesReadBy(const std::string& address);

// InvalidArgument if an output is a file that one of the inputs reads (the same device and inode under any name or
// link, or the same name if it does not exist yet), or if two outputs are the same file. Addresses that are not files
// (a URL, an empty one) are ignored.
[[nodiscard]] Outcome<void> keepApart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

}  // namespace relievo
