// SPDX-License-Identifier: Apache-2.0
// The cameras of a recording, what their pictures are, and where each picture is.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/openni/record.h"

namespace relievo::openni {

enum class NodeKind : std::uint32_t { Depth = 2, Color = 3, Infrared = 5 };

struct PicturePlace {
  std::uint64_t record = 0;  // position in the file
  std::int64_t time_us = 0;  // on the camera's clock
};

struct Node {
  std::uint32_t id = 0;
  NodeKind kind = NodeKind::Depth;
  std::string codec;  // "16zT", "16zP", "NONE", "JPEG", ..
  std::uint32_t cols = 0, rows = 0;
  std::uint64_t format = 0;      // OpenNI 2's number of the pixel format; 0: not said
  std::uint64_t old_format = 0;  // OpenNI 1's
  bool cropped = false;
  bool empty = false;                  // it says that it has no pictures
  std::uint64_t table = 0;             // of its pictures: the position of its record; 0: none
  std::vector<PicturePlace> pictures;  // in the file's order
};

// All nodes with pictures, including those that hold none. A recording that was cut off ends with its last whole
// record. Cancelled soon after the flag is set.
[[nodiscard]] Result<std::vector<Node>> findNodes(const RecordFile& file, const std::atomic<bool>& cancelled);

}  // namespace relievo::openni
