// SPDX-License-Identifier: Apache-2.0
// OpenNI's depth compression "16z": the difference of each sample to the one before, row by row.
#pragma once

#include <cstdint>
#include <span>

namespace relievo::openni {

// A difference of -6 to 6 takes half a byte, one of -63 to 63 a byte, a new value two bytes; one byte repeats two zero
// differences up to 15 times. False unless `packed` holds exactly as many samples as `samples` takes.
[[nodiscard]] bool unpack16z(std::span<const std::uint8_t> packed, std::span<std::uint16_t> samples) noexcept;

// The same with indices into a table of the picture's values, which `packed` begins with.
[[nodiscard]] bool unpack16zTable(std::span<const std::uint8_t> packed, std::span<std::uint16_t> samples) noexcept;

}  // namespace relievo::openni
