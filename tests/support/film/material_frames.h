// SPDX-License-Identifier: Apache-2.0
// Makes pictures of a material track from a function that gives their codes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "app/scene/material_map.h"
#include "hal/media/frame.h"

namespace relievo::test {

using MaterialCodes = std::array<std::uint8_t, 3>;  // stiffness, friction, texture

// 4:2:0 of full range; codes(x_mm, y_mm) at each sample's own place.
template <class Codes>
Frame makeMaterialFrame(int cols, int rows, const DisplayVolume& volume, MediaTime time, Codes&& codes) {
  auto samples = std::make_shared<std::vector<std::uint8_t>>();
  Frame frame;
  frame.pts = time;
  frame.width = cols;
  frame.height = rows;
  frame.model = ColorModel::Yuv;
  frame.range = ColorRange::Full;
  frame.chroma_shift_x = frame.chroma_shift_y = 1;
  frame.plane_count = 3;
  std::array<std::size_t, 3> begins{};
  for (std::uint8_t k = 0; k < 3; ++k) {
    begins[k] = samples->size();
    const int across = k == 0 ? cols : (cols + 1) / 2, down = k == 0 ? rows : (rows + 1) / 2;
    for (int r = 0; r < down; ++r) {
      for (int c = 0; c < across; ++c) {
        const double x = ((c + 0.5) / across - 0.5) * volume.width_mm, y = (0.5 - (r + 0.5) / down) * volume.height_mm;
        samples->push_back(codes(x, y)[k]);
      }
    }
    frame.components[k] = {.plane = k};
    frame.planes[k].stride_bytes = across;
  }
  for (std::size_t k = 0; k < 3; ++k) frame.planes[k].data = samples->data() + begins[k];
  frame.owner = samples;
  return frame;
}

template <class Codes>
std::shared_ptr<const MaterialMap> materialOf(int cols, int rows, const DisplayVolume& volume, Codes&& codes) {
  return std::make_shared<const MaterialMap>(
      MaterialMap::make(makeMaterialFrame(cols, rows, volume, {}, codes), volume).value());
}

}  // namespace relievo::test
