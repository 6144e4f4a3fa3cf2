// SPDX-License-Identifier: Apache-2.0
// Writes a PNG (ISO/IEC 15948) without compression, so that no library is needed.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "platform/error.h"

namespace relievo {

// `rgb`: rows from the top, three bytes a pixel. The file appears whole or not at all, and never replaces another one.
[[nodiscard]] Result<void> writePng(const std::string& path, int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace relievo
