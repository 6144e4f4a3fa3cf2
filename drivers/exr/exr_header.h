// SPDX-License-Identifier: Apache-2.0
// Checks an OpenEXR file's headers before the library reads them.
#pragma once

#include <cstdint>
#include <span>

namespace relievo::exr {

// Whether every attribute is as long as its type, and all of them and the chunks that they announce fit into the file:
// the library allocates what a size says before it reads ("OpenEXR File Layout"). False for a file with an ID manifest,
// which is compressed.
[[nodiscard]] bool fitsItsHeaders(std::span<const std::uint8_t> file) noexcept;

}  // namespace relievo::exr
