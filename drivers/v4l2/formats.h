// SPDX-License-Identifier: Apache-2.0
// The pixel formats of cameras in the words of hal/frame.h.
#pragma once

#include <linux/videodev2.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/frame.h"

namespace relievo::v4l2 {

struct Format {
  std::uint32_t fourcc = 0;
  const char* codec = "";  // of the StreamInfo
  bool depth = false;
  bool distances = false;  // mm, 0: no value
  std::uint8_t bits = 8;   // of a depth or gray sample
  bool raw = true;         // else another decoder's
};

// Null for one that is not known here.
[[nodiscard]] const Format* findFormat(std::uint32_t fourcc) noexcept;
// "Z16" -> its fourcc, filled up with blanks; nothing where it is none.
[[nodiscard]] std::optional<std::uint32_t> fourccOf(std::string_view name) noexcept;

// What a raw picture is like, but for its memory: `planes` hold offsets from its first byte until `placeAt`.
struct Layout {
  Frame frame;
  std::ptrdiff_t plane_offsets[2] = {0, 0};
  std::size_t bytes = 0;  // at least

  [[nodiscard]] Frame placeAt(const std::uint8_t* data) const noexcept;
};
// Nothing where the driver's answer makes no sense.
[[nodiscard]] std::optional<Layout> layoutOf(const Format& format, const v4l2_pix_format& picture) noexcept;

}  // namespace relievo::v4l2
