// SPDX-License-Identifier: Apache-2.0
// printf into a string: there is no std::format on GCC 12.
#pragma once

#include <string>

namespace relievo {

[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string print(const char* format, ...);

}  // namespace relievo
