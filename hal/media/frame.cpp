// SPDX-License-Identifier: Apache-2.0
// Makes gray frames; crops a frame by moving the first samples of its planes; chooses the weights of its luma.
#include "hal/media/frame.h"

#include <utility>

namespace relievo {

LumaWeights lumaWeights(const Frame& frame) noexcept {
  ColorMatrix matrix = frame.matrix;
  if (matrix == ColorMatrix::Unspecified) matrix = frame.height >= 720 ? ColorMatrix::Bt709 : ColorMatrix::Bt601;
  switch (matrix) {
    case ColorMatrix::Bt601:
      return {0.299, 0.114};
    case ColorMatrix::Bt2020:
      return {0.2627, 0.0593};
    default:
      return {0.2126, 0.0722};
  }
}

Frame grayFrame(std::shared_ptr<const std::vector<std::uint16_t>> samples, int cols, int rows) noexcept {
  Frame frame;
  frame.width = cols;
  frame.height = rows;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.components[0] = {.step_bytes = 2, .bits = 16};
  frame.planes[0] = {reinterpret_cast<const std::uint8_t*>(samples->data()), std::ptrdiff_t{2} * cols};
  frame.owner = std::move(samples);
  return frame;
}

Frame crop(const Frame& frame, int x, int y, int width, int height) noexcept {
  Frame part = frame;
  part.width = width;
  part.height = height;
  std::array<bool, 4> moved{};
  const auto move = [&](const Component& component, int column, int row) {
    if (std::exchange(moved[component.plane], true)) return;
    Plane& plane = part.planes[component.plane];
    const std::ptrdiff_t offset = row * plane.stride_bytes + static_cast<std::ptrdiff_t>(column) * component.step_bytes;
    plane.data += offset;
    part.dma_bufs[component.plane].offset_bytes += static_cast<std::uint32_t>(offset);
  };
  const int component_count = frame.model == ColorModel::Gray ? 1 : 3;
  for (int i = 0; i < component_count; ++i) {
    const bool chroma = frame.model == ColorModel::Yuv && i > 0;
    move(frame.components[static_cast<std::size_t>(i)], chroma ? x >> frame.chroma_shift_x : x,
         chroma ? y >> frame.chroma_shift_y : y);
  }
  if (frame.alpha) move(*frame.alpha, x, y);
  return part;
}

}  // namespace relievo
