// SPDX-License-Identifier: Apache-2.0
#include "hal/media/halved.h"

#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "platform/print.h"

namespace relievo {

std::string halvedLine(int width, int height) {
  return print("a photo of %d x %d, over 16.7 million samples: every second row and column is read", width, height);
}

Result<Frame> halved(const Frame& frame) {
  struct Group {
    int step_bytes = 0, cols = 0, rows = 0;
  };
  std::array<Group, 4> groups{};
  bool even = true;
  const auto add = [&](const Component& component, int shift_x, int shift_y) {
    const auto part = [](int samples, int shift) { return ((samples + 1) / 2 + (1 << shift) - 1) >> shift; };
    const Group group{component.step_bytes, part(frame.width, shift_x), part(frame.height, shift_y)};
    Group& of_plane = groups[component.plane];
    even =
        even && (of_plane.step_bytes == 0 || (of_plane.step_bytes == group.step_bytes && of_plane.cols == group.cols));
    of_plane = group;
  };
  const int component_count = frame.model == ColorModel::Gray ? 1 : 3;
  for (int i = 0; i < component_count; ++i) {
    const bool chroma = frame.model == ColorModel::Yuv && i > 0;
    add(frame.components[static_cast<std::size_t>(i)], chroma ? frame.chroma_shift_x : 0,
        chroma ? frame.chroma_shift_y : 0);
  }
  if (frame.alpha) add(*frame.alpha, 0, 0);
  if (!even) return fail(ErrorCode::Unsupported, "a picture of this sample format cannot be halved");

  Frame half = frame;
  half.width = (frame.width + 1) / 2;
  half.height = (frame.height + 1) / 2;
  half.dma_bufs = {};
  half.dma_modifier.reset();
  half.right.reset();
  try {
    auto planes = std::make_shared<std::array<std::vector<std::uint8_t>, 4>>();
    for (std::size_t k = 0; k < groups.size(); ++k) {
      const Group& group = groups[k];
      const auto step = static_cast<std::size_t>(group.step_bytes), cols = static_cast<std::size_t>(group.cols);
      std::vector<std::uint8_t>& samples = (*planes)[k];
      samples.resize(step * cols * static_cast<std::size_t>(group.rows));
      std::uint8_t* to = samples.data();
      for (int r = 0; r < group.rows; ++r) {
        const std::uint8_t* from = frame.planes[k].data + 2 * r * frame.planes[k].stride_bytes;
        for (std::size_t c = 0; c < cols; ++c, from += 2 * step, to += step) std::memcpy(to, from, step);
      }
      half.planes[k] = {samples.data(), static_cast<std::ptrdiff_t>(step * cols)};
    }
    half.owner = std::move(planes);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::Exhausted, "out of memory for a picture");
  }
  return half;
}

}  // namespace relievo
