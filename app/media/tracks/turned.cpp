// SPDX-License-Identifier: Apache-2.0
// Rotates a picture component by component.
#include "app/media/tracks/turned.h"

#include <algorithm>
#include <cerrno>
#include <new>
#include <utility>

namespace relievo {
namespace {

struct Size {
  int cols = 0, rows = 0;
};

// `component`: 0 to 2, or more for alpha.
Size sizeOf(const Frame& frame, std::size_t component) noexcept {
  if (frame.model != ColorModel::Yuv || component == 0 || component > 2) return {frame.width, frame.height};
  const auto part = [](int whole, int shift) { return (whole + (1 << shift) - 1) >> shift; };
  return {part(frame.width, frame.chroma_shift_x), part(frame.height, frame.chroma_shift_y)};
}

// One component: the source sample for output (0, 0), and the byte steps for one column and one row of the output.
struct Walk {
  const std::uint8_t* first;
  std::ptrdiff_t right, down;
};

Walk walkOf(const Component& c, const Plane& plane, Size size, int quarter_turns) noexcept {
  const std::ptrdiff_t col = c.step_bytes, row = plane.stride_bytes;
  const std::uint8_t* const top_left = plane.data + c.offset_bytes;
  const std::uint8_t* const bottom_left = top_left + (size.rows - 1) * row;
  switch (quarter_turns) {
    case 1:
      return {bottom_left, -row, col};
    case 2:
      return {bottom_left + (size.cols - 1) * col, -col, -row};
    default:
      return {top_left + (size.cols - 1) * col, row, -col};
  }
}

// In blocks, so that a column read as a row stays in the cache.
template <int kBytes>
void copyTurned(const Walk& from, Size size, std::uint8_t* to) noexcept {
  constexpr int kBlock = 32;
  for (int r0 = 0; r0 < size.rows; r0 += kBlock) {
    for (int c0 = 0; c0 < size.cols; c0 += kBlock) {
      for (int r = r0; r < std::min(r0 + kBlock, size.rows); ++r) {
        const std::uint8_t* in = from.first + r * from.down + c0 * from.right;
        std::uint8_t* out = to + (std::ptrdiff_t{r} * size.cols + c0) * kBytes;
        for (int c = c0; c < std::min(c0 + kBlock, size.cols); ++c, in += from.right, out += kBytes) {
          for (int i = 0; i < kBytes; ++i) out[i] = in[i];
        }
      }
    }
  }
}

void copyTurned(const Walk& from, Size size, int bytes, std::uint8_t* to) noexcept {
  switch (bytes) {
    case 1:
      return copyTurned<1>(from, size, to);
    case 2:
      return copyTurned<2>(from, size, to);
    case 3:
      return copyTurned<3>(from, size, to);
    default:
      return copyTurned<4>(from, size, to);
  }
}

// 8-bit red, green and blue in pixels of 3 or 4 bytes: they stay packed, since hue depth is read from such pixels.
bool isPackedRgb(const Frame& frame) noexcept {
  const Component& first = frame.components[0];
  return frame.model == ColorModel::Rgb && first.bits == 8 && (first.step_bytes == 3 || first.step_bytes == 4);
}

}  // namespace

Result<Frame> turned(const Frame& frame, int quarter_turns) noexcept {
  Frame upright = frame;
  if (quarter_turns % 2 != 0) {
    std::swap(upright.width, upright.height);
    std::swap(upright.chroma_shift_x, upright.chroma_shift_y);
    upright.sample_aspect = 1 / frame.sample_aspect;
  }
  upright.planes = {};
  upright.dma_bufs = {};
  upright.dma_modifier.reset();
  const bool packed = isPackedRgb(frame);
  const std::size_t colors = frame.model == ColorModel::Gray || packed ? 1 : 3;
  const bool own_alpha = frame.alpha && !packed;  // in a plane of its own
  upright.plane_count = static_cast<std::uint8_t>(colors + (own_alpha ? 1 : 0));

  const auto componentOf = [&](auto& of, std::size_t i) -> auto& { return i < colors ? of.components[i] : *of.alpha; };
  const auto sizeAt = [&](const Frame& of, std::size_t i) { return sizeOf(of, i < colors ? i : 3); };
  const auto bytesOf = [&](std::size_t i) {
    return packed ? frame.components[0].step_bytes : componentOf(frame, i).bits > 8 ? 2 : 1;
  };
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < upright.plane_count; ++i) {
    const Size size = sizeAt(upright, i);
    upright.planes[i].stride_bytes = std::ptrdiff_t{size.cols} * bytesOf(i);
    bytes += static_cast<std::size_t>(size.cols) * static_cast<std::size_t>(size.rows * bytesOf(i));
  }
  std::shared_ptr<std::uint8_t[]> memory;
  try {
    memory = std::make_shared_for_overwrite<std::uint8_t[]>(bytes);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::Exhausted, "out of memory for a turned picture", ENOMEM);
  }
  std::uint8_t* at = memory.get();
  for (std::size_t i = 0; i < upright.plane_count; ++i) {
    const Size size = sizeAt(upright, i);
    const Component& from = componentOf(frame, i);
    Walk walk = walkOf(from, frame.planes[from.plane], sizeAt(frame, i), quarter_turns);
    if (packed) walk.first -= frame.components[i].offset_bytes;  // the start of a pixel, not of its red component
    copyTurned(walk, size, bytesOf(i), at);
    upright.planes[i].data = at;
    at += upright.planes[i].stride_bytes * size.rows;
    if (packed) break;
    Component& c = componentOf(upright, i);
    c = {.plane = static_cast<std::uint8_t>(i),
         .offset_bytes = 0,
         .step_bytes = static_cast<std::uint8_t>(bytesOf(i)),
         .shift = c.shift,
         .bits = c.bits};
  }
  upright.owner = std::move(memory);
  return upright;
}

}  // namespace relievo
