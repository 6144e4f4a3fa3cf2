// SPDX-License-Identifier: Apache-2.0
// Pictures of a camera as packets of a video stream.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/openni/nodes.h"
#include "hal/media/media_source.h"

namespace relievo::openni {

inline constexpr std::uint64_t kMostPicture = std::uint64_t{64} << 20;  // bytes, packed or not

// Whether its pictures are of a known format and size.
[[nodiscard]] bool isReadable(const Node& node) noexcept;
// Why this depth cannot be felt; nullopt if it can.
[[nodiscard]] std::optional<Error> refusalOf(const Node& depth) noexcept;
// The title, and of a readable node all that a decoder and a reader of its codes need.
void describePictures(const Node& node, StreamInfo& stream);
// The packet, without times, of a readable node's picture; it owns `stored`. Nullopt if the picture is damaged.
[[nodiscard]] std::optional<Packet> packetOf(const Node& node, std::vector<std::uint8_t> stored);

}  // namespace relievo::openni
