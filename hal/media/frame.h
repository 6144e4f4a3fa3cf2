// SPDX-License-Identifier: Apache-2.0
// A reference to a decoded picture: where its samples are and how to read them, never a copy of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hal/media/media_time.h"

namespace relievo {

enum class ColorModel : std::uint8_t { Gray, Yuv, Rgb };
enum class ColorRange : std::uint8_t { Unspecified, Limited, Full };
enum class ColorMatrix : std::uint8_t { Unspecified, Bt601, Bt709, Bt2020 };
inline constexpr std::uint8_t kUnspecifiedColor = 2, kBt709 = 1;  // primaries and transfers of ITU-T H.273

// One memory plane. `stride_bytes` may be larger than a row, and negative for a picture stored upside down.
struct Plane {
  const std::uint8_t* data = nullptr;
  std::ptrdiff_t stride_bytes = 0;
};

// The same plane as a dma-buf, for other devices: its first sample is at `offset_bytes` in `fd`, which the frame's
// owner keeps open; rows have the plane's stride. -1: there is no dma-buf.
struct DmaBuf {
  int fd = -1;
  std::uint32_t offset_bytes = 0;
};

// A component's sample (c, r) is at planes[plane].data + r * stride_bytes + offset_bytes + c * step_bytes.
// 8 bits or fewer are one byte; 9 to 16 bits are two bytes, little endian. The value is (word >> shift), `bits` wide.
struct Component {
  std::uint8_t plane = 0;
  std::uint8_t offset_bytes = 0;
  std::uint8_t step_bytes = 1;
  std::uint8_t shift = 0;
  std::uint8_t bits = 8;
};

// How a picture stores two views of one scene, as its coded data say. Other: in a way that is not shown.
struct ViewLayout {
  enum class Way : std::uint8_t { OneView, SideBySide, TopBottom, Other };
  Way way = Way::OneView;
  bool right_first = false;
};

// The code of the sample that begins at `sample`.
[[nodiscard]] inline std::uint32_t codeAt(const Component& component, const std::uint8_t* sample) noexcept {
  const std::uint32_t low = sample[0];
  const std::uint32_t word = component.bits > 8 ? low | static_cast<std::uint32_t>(sample[1]) << 8 : low;
  return (word >> component.shift) & ((1U << component.bits) - 1);
}

// Gray: components[0]. Yuv: Y, U, V; U and V have (width >> chroma_shift_x, rounded up) columns, rows likewise.
// Rgb: R, G, B. This covers planar, semi-planar and packed formats; back ends convert all other formats.
//
// A Frame is a view with shared ownership: copying it copies a reference. The samples do not change while any copy
// lives. Dropping the last copy may free memory, so a real-time thread never holds one of its own.
struct Frame {
  MediaTime pts;
  Duration duration{0};  // 0 if unknown
  int width = 0;
  int height = 0;
  ColorModel model = ColorModel::Gray;
  ColorRange range = ColorRange::Unspecified;
  ColorMatrix matrix = ColorMatrix::Unspecified;
  std::uint8_t primaries = kUnspecifiedColor;  // ITU-T H.273, 8.1: 9 BT.2020, ..
  std::uint8_t transfer = kUnspecifiedColor;   // likewise, 8.2: 16 PQ, 18 HLG, ..
  bool interlaced = false;                     // odd and even rows were taken at different times,
  bool top_field_first = true;                 // even rows (from 0) before odd ones
  double sample_aspect = 1.0;                  // width of a sample over its height
  ViewLayout views;
  double value_per_code =
      0;  // floating-point value of one code (hal/media/float_codes.h); 0: the samples were whole numbers
  double value_at_zero = 0;  // of code 0, if the numbers lie on both sides of 0
  std::uint8_t chroma_shift_x = 0;
  std::uint8_t chroma_shift_y = 0;
  std::uint8_t plane_count = 0;
  std::array<Component, 3> components{};
  std::optional<Component> alpha;  // full range, as large as the picture, whatever the range of the others
  std::array<Plane, 4> planes{};
  std::array<DmaBuf, 4> dma_bufs{};           // one for each plane
  std::optional<std::uint64_t> dma_modifier;  // their memory layout (drm_fourcc.h), if known
  std::shared_ptr<const void> owner;
  // The right eye's picture of the same moment, which the same packet held (MV-HEVC); this one is then the left eye's.
  std::shared_ptr<const Frame> right;

  [[nodiscard]] bool empty() const noexcept { return planes[0].data == nullptr; }
};

// The shares of red and blue in the luma of a YUV frame: ITU-R BT.601-7, BT.709-6, BT.2020-2. An unspecified matrix is
// guessed from the frame's size, as players do.
struct LumaWeights {
  double red = 0.299, blue = 0.114;
};
[[nodiscard]] LumaWeights lumaWeights(const Frame& frame) noexcept;

// A full-range gray frame of 16-bit samples, row by row without padding, at time 0. It owns `samples`, which hold
// cols x rows.
[[nodiscard]] Frame grayFrame(std::shared_ptr<const std::vector<std::uint16_t>> samples, int cols, int rows) noexcept;

// The part of `frame` of `width` x `height` samples that begins at (x, y), as a view of the same memory.
// x and y must be multiples of the chroma subsampling, and the part must lie inside the frame.
[[nodiscard]] Frame crop(const Frame& frame, int x, int y, int width, int height) noexcept;

}  // namespace relievo
