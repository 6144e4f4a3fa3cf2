// SPDX-License-Identifier: Apache-2.0
// The layout of a hardware decoder's pictures in its buffers.
#pragma once

#include <linux/videodev2.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/v4l2/m2m_buffers.h"
#include "hal/media/frame.h"
#include "hal/media/media_source.h"

namespace relievo::v4l2 {

inline constexpr const char* kUnreadable = "the video hardware's picture format is not supported";

// True if pictures of this fourcc can be read.
[[nodiscard]] bool isPictureFormat(std::uint32_t fourcc) noexcept;

// A picture's layout without its memory: each plane begins at an offset in one of the buffer's memory planes.
struct PictureLayout {
  Frame frame;  // of the coded size
  v4l2_rect visible{};
  std::array<std::uint8_t, 3> memory{};
  std::array<std::size_t, 3> offset{};
  std::array<std::size_t, 3> bytes{};  // the least that each memory plane has

  [[nodiscard]] bool fits(const std::array<M2mBuffers::Memory, M2mBuffers::kMostPlanes>& buffer) const noexcept;
  // The visible part as a frame. `data`, `dma_bufs` (-1: none): of each memory plane.
  [[nodiscard]] Frame placeAt(const std::array<const std::uint8_t*, 3>& data,
                              const std::array<int, 3>& dma_bufs) const noexcept;
};
// `field`: a V4L2_FIELD. Before, `frame` says which field is first where the driver does not.
void setFields(Frame& frame, std::uint32_t field) noexcept;
// nullopt for an unsupported format or an impossible answer. The stream's colour signalling overrides the driver's.
[[nodiscard]] std::optional<PictureLayout> layoutOf(const v4l2_format& format, std::optional<v4l2_rect> visible,
                                                    const StreamInfo& stream) noexcept;

}  // namespace relievo::v4l2
