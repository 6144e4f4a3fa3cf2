// SPDX-License-Identifier: Apache-2.0
// Crops a frame by moving the first samples of its planes; chooses the weights of its luma.
#include "hal/frame.h"

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

Frame crop(const Frame& frame, int x, int y, int width, int height) noexcept {
  Frame part = frame;
  part.width = width;
  part.height = height;
  std::array<bool, 4> moved{};
  const int component_count = frame.model == ColorModel::Gray ? 1 : 3;
  for (int i = 0; i < component_count; ++i) {
    const Component& component = frame.components[static_cast<std::size_t>(i)];
    if (moved[component.plane]) continue;
    moved[component.plane] = true;
    const bool chroma = frame.model == ColorModel::Yuv && i > 0;
    const int column = chroma ? x >> frame.chroma_shift_x : x;
    const int row = chroma ? y >> frame.chroma_shift_y : y;
    Plane& plane = part.planes[component.plane];
    const std::ptrdiff_t offset = row * plane.stride_bytes + static_cast<std::ptrdiff_t>(column) * component.step_bytes;
    plane.data += offset;
    part.dma_bufs[component.plane].offset_bytes += static_cast<std::uint32_t>(offset);
  }
  return part;
}

}  // namespace relievo
