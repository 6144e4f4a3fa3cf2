// SPDX-License-Identifier: Apache-2.0
// Keeps what a program writes off what it reads: no output may destroy an input.
#pragma once

#include <string>
#include <vector>

#include "platform/failure.h"

namespace relievo {

// The files that are read when `address` is opened, as far as they are there: the file itself (a `file:` address too),
// the pictures of a numbered sequence (`%04d`), and what a playlist names, lists in lists included. Empty for what is
// no file. Bounded: lists of up to 1 MiB, four deep, 10,000 files.
[[nodiscard]] std::vector<std::string> filesReadBy(const std::string& address);

// InvalidArgument for an output that is a file which one of the inputs reads (the same file by device and inode, under
// whatever name or link, or the same name where there is no file yet), or which is another output as well. Words that
// name no file (a URL, an empty one) are passed over.
[[nodiscard]] Outcome<void> keepApart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

}  // namespace relievo
