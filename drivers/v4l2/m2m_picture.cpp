// SPDX-License-Identifier: Apache-2.0
// The layouts of 8-bit 4:2:0 (Documentation/userspace-api/media/v4l/pixfmt-yuv-planar.rst) and gray.
#include "drivers/v4l2/m2m_picture.h"

#include <algorithm>
#include <utility>

namespace relievo::v4l2 {
namespace {

struct Arrangement {
  std::uint32_t fourcc;
  std::uint8_t planes, memories;
  bool v_first = false;
};
constexpr std::array kArrangements{
    Arrangement{V4L2_PIX_FMT_NV12, 2, 1},    Arrangement{V4L2_PIX_FMT_NV21, 2, 1, true},
    Arrangement{V4L2_PIX_FMT_NV12M, 2, 2},   Arrangement{V4L2_PIX_FMT_NV21M, 2, 2, true},
    Arrangement{V4L2_PIX_FMT_YUV420, 3, 1},  Arrangement{V4L2_PIX_FMT_YVU420, 3, 1, true},
    Arrangement{V4L2_PIX_FMT_YUV420M, 3, 3}, Arrangement{V4L2_PIX_FMT_YVU420M, 3, 3, true},
    Arrangement{V4L2_PIX_FMT_GREY, 1, 1},
};

const Arrangement* find(std::uint32_t fourcc) noexcept {
  const auto found =
      std::find_if(kArrangements.begin(), kArrangements.end(), [&](auto& a) { return a.fourcc == fourcc; });
  return found == kArrangements.end() ? nullptr : &*found;
}

// The fields common to the single- and multi-planar forms of a format.
struct Told {
  std::uint32_t fourcc = 0, width = 0, height = 0;
  std::array<std::uint32_t, 3> strides{};
  std::uint32_t range = 0, matrix = 0;
};
Told told(const v4l2_format& format) noexcept {
  if (!V4L2_TYPE_IS_MULTIPLANAR(format.type)) {
    const v4l2_pix_format& p = format.fmt.pix;
    return {p.pixelformat, p.width, p.height, {p.bytesperline}, p.quantization, p.ycbcr_enc};
  }
  const v4l2_pix_format_mplane& p = format.fmt.pix_mp;
  return {p.pixelformat,  p.width,
          p.height,       {p.plane_fmt[0].bytesperline, p.plane_fmt[1].bytesperline, p.plane_fmt[2].bytesperline},
          p.quantization, p.ycbcr_enc};
}

void arrange(Frame& frame, const Arrangement& a) noexcept {
  frame.plane_count = a.planes;
  frame.model = a.planes == 1 ? ColorModel::Gray : ColorModel::Yuv;
  if (a.planes == 1) return;
  frame.chroma_shift_x = frame.chroma_shift_y = 1;
  const bool together = a.planes == 2;
  for (std::uint8_t i = 1; i <= 2; ++i) {
    const auto place = static_cast<std::uint8_t>(a.v_first ? 2 - i : i - 1);
    frame.components[i] = together ? Component{.plane = 1, .offset_bytes = place, .step_bytes = 2}
                                   : Component{.plane = static_cast<std::uint8_t>(1 + place)};
  }
}

void signal(Frame& frame, const Told& t, const StreamInfo& stream) noexcept {
  frame.range = stream.range;
  frame.matrix = stream.matrix;
  frame.primaries = stream.primaries;
  frame.transfer = stream.transfer;
  frame.sample_aspect = stream.sample_aspect;
  frame.top_field_first = stream.fields != FieldOrder::BottomBottom && stream.fields != FieldOrder::TopBottom;
  if (frame.range == ColorRange::Unspecified && t.range == V4L2_QUANTIZATION_FULL_RANGE) frame.range = ColorRange::Full;
  if (frame.range == ColorRange::Unspecified && t.range == V4L2_QUANTIZATION_LIM_RANGE) {
    frame.range = ColorRange::Limited;
  }
}

}  // namespace

bool isPictureFormat(std::uint32_t fourcc) noexcept {
  return find(fourcc) != nullptr;
}

bool PictureLayout::fits(const std::array<M2mBuffers::Memory, M2mBuffers::kMostPlanes>& buffer) const noexcept {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (buffer[i].bytes < bytes[i]) return false;
  }
  return true;
}

Frame PictureLayout::placeAt(const std::array<const std::uint8_t*, 3>& data,
                             const std::array<int, 3>& dma_bufs) const noexcept {
  Frame placed = frame;
  for (std::size_t i = 0; i < placed.plane_count; ++i) {
    placed.planes[i].data = data[memory[i]] + offset[i];
    placed.dma_bufs[i] = {dma_bufs[memory[i]], static_cast<std::uint32_t>(offset[i])};
  }
  return crop(placed, visible.left, visible.top, static_cast<int>(visible.width), static_cast<int>(visible.height));
}

void setFields(Frame& frame, std::uint32_t field) noexcept {
  frame.interlaced =
      field == V4L2_FIELD_INTERLACED || field == V4L2_FIELD_INTERLACED_TB || field == V4L2_FIELD_INTERLACED_BT;
  if (!frame.interlaced || field == V4L2_FIELD_INTERLACED_TB) frame.top_field_first = true;
  if (field == V4L2_FIELD_INTERLACED_BT) frame.top_field_first = false;
}

std::optional<PictureLayout> layoutOf(const v4l2_format& format, std::optional<v4l2_rect> visible,
                                      const StreamInfo& stream) noexcept {
  constexpr std::uint32_t kLargest = 1U << 15;
  const Told t = told(format);
  const Arrangement* const a = find(t.fourcc);
  if (a == nullptr || t.width < 1 || t.height < 1 || t.width > kLargest || t.height > kLargest) return std::nullopt;
  PictureLayout layout;
  layout.frame.width = static_cast<int>(t.width);
  layout.frame.height = static_cast<int>(t.height);
  arrange(layout.frame, *a);
  signal(layout.frame, t, stream);

  const std::uint32_t luma = t.strides[0] == 0 ? t.width : t.strides[0];
  for (std::size_t i = 0; i < a->planes; ++i) {
    const bool chroma = i > 0;
    const bool apart = chroma && a->planes == 3;  // U and V are not interleaved
    const std::uint32_t across = !chroma ? t.width : (t.width + 1) / 2 * (apart ? 1 : 2);
    const std::uint32_t usual = apart ? luma / 2 : luma;
    const std::uint32_t stride = chroma && a->memories > 1 && t.strides[i] != 0 ? t.strides[i] : usual;
    const std::uint32_t rows = chroma ? (t.height + 1) / 2 : t.height;
    if (stride < across || stride > 4 * kLargest) return std::nullopt;
    const auto memory = static_cast<std::uint8_t>(a->memories > 1 ? i : 0);
    layout.memory[i] = memory;
    layout.offset[i] = layout.bytes[memory];
    layout.bytes[memory] += std::size_t{stride} * rows;
    layout.frame.planes[i].stride_bytes = stride;
  }

  layout.visible = visible.value_or(v4l2_rect{0, 0, t.width, t.height});
  const v4l2_rect& v = layout.visible;
  const bool inside = v.left >= 0 && v.top >= 0 && v.width > 0 && v.height > 0 &&
                      static_cast<std::uint64_t>(v.left) + v.width <= t.width &&
                      static_cast<std::uint64_t>(v.top) + v.height <= t.height && v.left % 2 == 0 && v.top % 2 == 0;
  if (!inside) layout.visible = {0, 0, t.width, t.height};
  return layout;
}

}  // namespace relievo::v4l2
