// SPDX-License-Identifier: Apache-2.0
// Unpacks the data of a compressed chunk.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/rosbag/record.h"

namespace relievo::rosbag {

// As much as could be unpacked of a chunk that is to have `plain_bytes`: less if its data is damaged or cut off. Memory
// grows with what comes out, not with what is announced.
[[nodiscard]] std::vector<std::uint8_t> unpackLz4(const Range& packed, std::size_t plain_bytes);
[[nodiscard]] std::vector<std::uint8_t> unpackBz2(const Range& packed, std::size_t plain_bytes);
[[nodiscard]] std::vector<std::uint8_t> unpackZstd(const Range& packed, std::size_t plain_bytes);

}  // namespace relievo::rosbag
