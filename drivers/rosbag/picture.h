// SPDX-License-Identifier: Apache-2.0
// Pictures in messages as packets of a video stream.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/rosbag/messages.h"
#include "hal/media/media_source.h"

namespace relievo::rosbag {

// What the pictures of a topic are, as the first one says.
struct PictureKind {
  std::string codec;         // "rawvideo", "mjpeg", "png"
  std::string pixel_format;  // of raw pictures: FFmpeg's name, in little endian
  std::uint32_t cols = 0, rows = 0;
  std::uint32_t pixel_bytes = 0, sample_bytes = 1;  // of raw pictures
  std::size_t skipped_bytes = 0;                    // before the coded picture
  bool color = false;                               // more than one component
  bool distances = false;                           // whole numbers or floats that a depth camera measures
  std::map<std::string, std::string> tags;          // what its codes mean; of distances
};

// Nullopt if the encoding is unknown.
[[nodiscard]] std::optional<PictureKind> kindOf(const PictureMessage& picture, Bytes message);

// The packet, without times, of a message of this kind; it owns `message`. Nullopt if the picture is damaged or of
// another kind.
[[nodiscard]] std::optional<Packet> packetOf(const PictureKind& kind, const PictureMessage& picture,
                                             std::vector<std::uint8_t> message);

}  // namespace relievo::rosbag
