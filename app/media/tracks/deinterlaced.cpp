// SPDX-License-Identifier: Apache-2.0
#include "app/media/tracks/deinterlaced.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

namespace relievo {
namespace {

// The rows of a plane, and the bytes of a row that hold samples.
struct PlaneSize {
  int rows = 0;
  std::size_t bytes = 0;
};

PlaneSize sizeOf(const Frame& frame, std::size_t plane) noexcept {
  PlaneSize size;
  const std::size_t components = frame.model == ColorModel::Gray ? 1 : 3;
  for (std::size_t i = 0; i < components; ++i) {
    const Component& c = frame.components[i];
    if (c.plane != plane) continue;
    const bool chroma = frame.model == ColorModel::Yuv && i > 0;
    const int shift_x = chroma ? frame.chroma_shift_x : 0, shift_y = chroma ? frame.chroma_shift_y : 0;
    const int cols = (frame.width + (1 << shift_x) - 1) >> shift_x;
    size.rows = std::max(size.rows, (frame.height + (1 << shift_y) - 1) >> shift_y);
    size.bytes = std::max(size.bytes, static_cast<std::size_t>(cols) * c.step_bytes);
  }
  if (frame.alpha && frame.alpha->plane == plane) {
    size.rows = frame.height;
    size.bytes = std::max(size.bytes, static_cast<std::size_t>(frame.width) * frame.alpha->step_bytes);
  }
  return size;
}

template <class Word>
void medianRow(const std::uint8_t* above, const std::uint8_t* own, const std::uint8_t* below, std::uint8_t* to,
               std::size_t bytes) noexcept {
  for (std::size_t i = 0; i + sizeof(Word) <= bytes; i += sizeof(Word)) {
    Word a = 0, b = 0, c = 0;
    std::memcpy(&a, above + i, sizeof a);
    std::memcpy(&b, own + i, sizeof b);
    std::memcpy(&c, below + i, sizeof c);
    const Word median = std::max(std::min(a, b), std::min(std::max(a, b), c));
    std::memcpy(to + i, &median, sizeof median);
  }
}

void fillPlane(const Plane& from, const PlaneSize& size, int first_field, bool words, std::uint8_t* to) noexcept {
  const auto row = [&](int r) { return from.data + r * from.stride_bytes; };
  for (int r = 0; r < size.rows; ++r, to += size.bytes) {
    const bool kept = r % 2 == first_field;
    if (kept || size.rows < 2) {
      std::memcpy(to, row(r), size.bytes);
      continue;
    }
    const std::uint8_t* const above = row(r > 0 ? r - 1 : r + 1);
    const std::uint8_t* const below = row(r + 1 < size.rows ? r + 1 : r - 1);
    (words ? medianRow<std::uint16_t> : medianRow<std::uint8_t>)(above, row(r), below, to, size.bytes);
  }
}

}  // namespace

Result<Frame> deinterlaced(const Frame& frame) noexcept {
  Frame whole = frame;
  whole.interlaced = false;
  whole.dma_bufs = {};
  whole.dma_modifier.reset();
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < frame.plane_count; ++i) {
    const PlaneSize size = sizeOf(frame, i);
    bytes += static_cast<std::size_t>(size.rows) * size.bytes;
  }
  std::shared_ptr<std::uint8_t[]> memory;
  try {
    memory = std::make_shared_for_overwrite<std::uint8_t[]>(bytes);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::Exhausted, "out of memory for a deinterlaced picture", ENOMEM);
  }
  std::uint8_t* at = memory.get();
  for (std::size_t i = 0; i < frame.plane_count; ++i) {
    const PlaneSize size = sizeOf(frame, i);
    fillPlane(frame.planes[i], size, frame.top_field_first ? 0 : 1, frame.components[0].bits > 8, at);
    whole.planes[i] = {at, static_cast<std::ptrdiff_t>(size.bytes)};
    at += static_cast<std::size_t>(size.rows) * size.bytes;
  }
  whole.owner = std::move(memory);
  return whole;
}

}  // namespace relievo
