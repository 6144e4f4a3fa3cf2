// SPDX-License-Identifier: Apache-2.0
// OpenNI's packing of depth, "16z": steps from one sample to the next, row by row.
#pragma once

#include <cstdint>
#include <span>

namespace relievo::openni {

// A step of -6 to 6 takes half a byte, one of -63 to 63 a byte, a new value two; twice no step is repeated up to 15
// times by one byte. False unless `packed` holds exactly as many samples as `samples` takes.
[[nodiscard]] bool unpack16z(std::span<const std::uint8_t> packed, std::span<std::uint16_t> samples) noexcept;

// The same for places in a table of all values of the picture, which comes first.
[[nodiscard]] bool unpack16zTable(std::span<const std::uint8_t> packed, std::span<std::uint16_t> samples) noexcept;

}  // namespace relievo::openni
