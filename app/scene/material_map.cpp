// SPDX-License-Identifier: Apache-2.0
// Places each plane's samples in the scene, and reads between them.
#include "app/scene/material_map.h"

#include <algorithm>

namespace relievo {

Result<MaterialMap> MaterialMap::make(const Frame& picture, const DisplayVolume& volume) noexcept {
  const auto is_byte = [](const Component& c) { return c.bits == 8 && c.shift == 0; };
  if (picture.model != ColorModel::Yuv || !std::ranges::all_of(picture.components, is_byte)) {
    return fail(ErrorCode::Unsupported, "a material track is YUV of 8 bits; make it with relievo-author --material");
  }
  MaterialMap map;
  map.picture_ = picture;
  const bool limited = picture.range == ColorRange::Limited;
  for (std::size_t k = 0; k < map.layers_.size(); ++k) {
    const Component& c = picture.components[k];
    const Plane& plane = picture.planes[c.plane];
    Layer& layer = map.layers_[k];
    layer.data = plane.data + c.offset_bytes;
    layer.stride = plane.stride_bytes;
    layer.step = c.step_bytes;
    const int shift_x = k == 0 ? 0 : picture.chroma_shift_x, shift_y = k == 0 ? 0 : picture.chroma_shift_y;
    layer.cols = (picture.width + (1 << shift_x) - 1) >> shift_x;
    layer.rows = (picture.height + (1 << shift_y) - 1) >> shift_y;
    layer.grid = GridMapping(volume, layer.cols, layer.rows);
    if (limited) {
      layer.scale = 1.0 / (k == 0 ? 219 : 224);
      layer.offset = -16 * layer.scale;
    }
  }
  return map;
}

double MaterialMap::Layer::at(double x_mm, double y_mm) const RELIEVO_RT {
  const double u = std::clamp(grid.u(x_mm), 0.0, cols - 1.0);
  const double v = std::clamp(grid.v(y_mm), 0.0, rows - 1.0);
  const int c = static_cast<int>(u), r = static_cast<int>(v);
  const double s = u - c, t = v - r;
  const std::uint8_t* const above = data + r * stride + c * step;
  const std::uint8_t* const below = above + (r + 1 < rows ? stride : 0);
  const std::ptrdiff_t right = c + 1 < cols ? step : 0;
  const double upper = above[0] + s * (above[right] - above[0]), lower = below[0] + s * (below[right] - below[0]);
  return std::clamp(offset + scale * (upper + t * (lower - upper)), 0.0, 1.0);
}

MaterialMap::Shares MaterialMap::at(double x_mm, double y_mm) const RELIEVO_RT {
  return {layers_[0].at(x_mm, y_mm), layers_[1].at(x_mm, y_mm), layers_[2].at(x_mm, y_mm)};
}

}  // namespace relievo
