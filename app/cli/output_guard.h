// SPDX-License-Identifier: Apache-2.0
// Refuses an output that would overwrite an input.
#pragma once

#include <string>
#include <vector>

#include "platform/failure.h"

namespace relievo {

// InvalidArgument if an output is a file that one of the inputs reads (`filesReadBy`; the same device and inode under
// any name or link, or the same name if it does not exist yet), or if two outputs are the same file. Addresses that are
// not files (a URL, an empty one) are ignored.
[[nodiscard]] Outcome<void> keepApart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

}  // namespace relievo
