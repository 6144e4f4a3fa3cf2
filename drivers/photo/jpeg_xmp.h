// SPDX-License-Identifier: Apache-2.0
// The metadata of a JPEG file: segments, XMP and rotation.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relievo::photo {

// The standard XMP packet, followed by the extended one, whose parts are put together (Adobe, "XMP specification",
// part 3, 1.1.3). Empty if there is none, or if the file is no JPEG.
[[nodiscard]] std::string xmpOf(std::span<const std::uint8_t> jpeg);

// The contents of the segments of this marker (0xe0 to 0xef: APP0 to APP15) before the picture, in order.
[[nodiscard]] std::vector<std::string_view> segmentsOf(std::span<const std::uint8_t> jpeg, std::uint8_t marker);

// The clockwise quarter turns that make the picture upright, as its EXIF metadata says; nullopt if it says nothing.
[[nodiscard]] std::optional<int> exifRotation(std::span<const std::uint8_t> jpeg);

// The value of a property, "GDepth:Near", written as an attribute or as an element; the first one. Entities are not
// resolved.
[[nodiscard]] std::optional<std::string_view> property(std::string_view xmp, std::string_view name);

// RFC 4648, with blanks between; nullopt for other characters.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> fromBase64(std::string_view text);

}  // namespace relievo::photo
