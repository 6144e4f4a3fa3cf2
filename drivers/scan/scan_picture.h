// SPDX-License-Identifier: Apache-2.0
// The pictures of a scan as packets that a decoder takes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/scan/scan_file.h"
#include "hal/media/media_source.h"

namespace relievo::scan {

struct PictureSize {
  std::uint32_t cols = 0, rows = 0;
};
// As the frame header of the JPEG says (ITU-T T.81, B.2.2); nullopt if it is no JPEG.
[[nodiscard]] std::optional<PictureSize> jpegSize(std::span<const std::uint8_t> jpeg) noexcept;

// Nullopt unless all of it is there.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> readPlace(const AnsweredFile& file, const Place& place);

// The codec, size and tags of the scan's depth, or colour.
void describePictures(const Scan& scan, bool depth, StreamInfo& stream);
// Nullopt for a raw picture of another size.
[[nodiscard]] std::optional<Packet> packetOf(const Scan& scan, bool depth, std::vector<std::uint8_t> stored);

}  // namespace relievo::scan
