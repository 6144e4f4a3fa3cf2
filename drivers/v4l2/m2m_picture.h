// SPDX-License-Identifier: Apache-2.0
// How a decoder's pictures lie in its buffers.
#pragma once

#include <linux/videodev2.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/v4l2/m2m_buffers.h"
#include "hal/frame.h"
#include "hal/media_source.h"

namespace relievo::v4l2 {

// Whether pictures of this fourcc can be read.
[[nodiscard]] bool isPictureFormat(std::uint32_t fourcc) noexcept;

// A picture but for its memory: each plane is so many bytes into one of the buffer's memories.
struct PictureLayout {
  Frame frame;  // of the size that is coded
  v4l2_rect visible{};
  std::array<std::uint8_t, 3> memory{};
  std::array<std::size_t, 3> offset{};
  std::array<std::size_t, 3> bytes{};  // of each memory, at least

  [[nodiscard]] bool fits(const std::array<M2mBuffers::Memory, M2mBuffers::kMostPlanes>& buffer) const noexcept;
  // `data` and `dma_bufs` (-1: none) of each memory. The visible part alone.
  [[nodiscard]] Frame placeAt(const std::array<const std::uint8_t*, 3>& data,
                              const std::array<int, 3>& dma_bufs) const noexcept;
};
// Nothing for a format that cannot be read, or an answer that makes no sense. What the stream says of its colours goes
// before what the driver says.
[[nodiscard]] std::optional<PictureLayout> layoutOf(const v4l2_format& format, std::optional<v4l2_rect> visible,
                                                    const StreamInfo& stream) noexcept;

}  // namespace relievo::v4l2
