// SPDX-License-Identifier: Apache-2.0
// Describes the pixel formats of cameras in the types of hal/media/frame.h.
#pragma once

#include <linux/videodev2.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/media/frame.h"

namespace relievo::v4l2 {

struct Format {
  std::uint32_t fourcc = 0;
  const char* codec = "";  // for StreamInfo
  bool depth = false;
  bool distances = false;  // in mm; 0: no value
  std::uint8_t bits = 8;   // of a depth or gray sample
  bool raw = true;         // false: coded, for another decoder
};

// Null for an unsupported format.
[[nodiscard]] const Format* findFormat(std::uint32_t fourcc) noexcept;
// The fourcc of a name such as "Z16", padded with blanks; nullopt if the name is not one.
[[nodiscard]] std::optional<std::uint32_t> fourccOf(std::string_view name) noexcept;

// The layout of a raw picture; `placeAt` fills in its memory.
struct Layout {
  Frame frame;
  std::ptrdiff_t plane_offsets[2] = {0, 0};
  std::size_t bytes = 0;  // the least that a picture has

  [[nodiscard]] Frame placeAt(const std::uint8_t* data) const noexcept;
};
// nullopt if the driver's answer is impossible.
[[nodiscard]] std::optional<Layout> layoutOf(const Format& format, const v4l2_pix_format& picture) noexcept;

}  // namespace relievo::v4l2
