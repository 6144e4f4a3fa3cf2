// SPDX-License-Identifier: Apache-2.0
// The table of formats (Documentation/userspace-api/media/v4l/pixfmt.rst).
#include "drivers/v4l2/formats.h"

#include <algorithm>
#include <array>

namespace relievo::v4l2 {
namespace {

constexpr std::array kFormats{
    Format{V4L2_PIX_FMT_Z16, "z16", true, true, 16},
    Format{V4L2_PIX_FMT_Y16, "y16", true, false, 16},
    Format{V4L2_PIX_FMT_Y12, "y12", true, false, 12},
    Format{V4L2_PIX_FMT_Y10, "y10", true, false, 10},
    Format{V4L2_PIX_FMT_YUYV, "yuyv"},
    Format{V4L2_PIX_FMT_UYVY, "uyvy"},
    Format{V4L2_PIX_FMT_NV12, "nv12"},
    Format{V4L2_PIX_FMT_RGB24, "rgb3"},
    Format{V4L2_PIX_FMT_BGR24, "bgr3"},
    Format{V4L2_PIX_FMT_GREY, "grey"},
    Format{V4L2_PIX_FMT_MJPEG, "mjpeg", false, false, 8, false},
    Format{V4L2_PIX_FMT_JPEG, "mjpeg", false, false, 8, false},
    Format{V4L2_PIX_FMT_H264, "h264", false, false, 8, false},
};

// The plane, the offset in bytes and the step of a component.
struct Place {
  std::uint8_t plane, offset, step;
};
void place(Frame& frame, ColorModel model, std::array<Place, 3> places) noexcept {
  frame.model = model;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& p = places[i];
    frame.components[i] = {.plane = p.plane, .offset_bytes = p.offset, .step_bytes = p.step};
  }
}

int bytesAcross(std::uint32_t fourcc, int width) noexcept {
  switch (fourcc) {
    case V4L2_PIX_FMT_GREY:
    case V4L2_PIX_FMT_NV12:
      return width;
    case V4L2_PIX_FMT_RGB24:
    case V4L2_PIX_FMT_BGR24:
      return 3 * width;
    default:
      return 2 * width;
  }
}

void arrange(Frame& frame, const Format& format) noexcept {
  switch (format.fourcc) {
    case V4L2_PIX_FMT_YUYV:
      place(frame, ColorModel::Yuv, {{{0, 0, 2}, {0, 1, 4}, {0, 3, 4}}});
      frame.chroma_shift_x = 1;
      break;
    case V4L2_PIX_FMT_UYVY:
      place(frame, ColorModel::Yuv, {{{0, 1, 2}, {0, 0, 4}, {0, 2, 4}}});
      frame.chroma_shift_x = 1;
      break;
    case V4L2_PIX_FMT_NV12:
      place(frame, ColorModel::Yuv, {{{0, 0, 1}, {1, 0, 2}, {1, 1, 2}}});
      frame.chroma_shift_x = frame.chroma_shift_y = 1;
      frame.plane_count = 2;
      break;
    case V4L2_PIX_FMT_RGB24:
      place(frame, ColorModel::Rgb, {{{0, 0, 3}, {0, 1, 3}, {0, 2, 3}}});
      break;
    case V4L2_PIX_FMT_BGR24:
      place(frame, ColorModel::Rgb, {{{0, 2, 3}, {0, 1, 3}, {0, 0, 3}}});
      break;
    default:
      frame.model = ColorModel::Gray;
      frame.components[0] = {.step_bytes = static_cast<std::uint8_t>(format.bits > 8 ? 2 : 1), .bits = format.bits};
  }
}

ColorMatrix matrixOf(std::uint32_t encoding) noexcept {
  switch (encoding) {
    case V4L2_YCBCR_ENC_709:
    case V4L2_YCBCR_ENC_XV709:
      return ColorMatrix::Bt709;
    case V4L2_YCBCR_ENC_BT2020:
      return ColorMatrix::Bt2020;
    default:
      return ColorMatrix::Bt601;
  }
}

// What the driver leaves open follows from its colour space, by the kernel's own rules.
void signal(Frame& frame, const v4l2_pix_format& picture) noexcept {
  const bool told = picture.priv == V4L2_PIX_FMT_PRIV_MAGIC;
  const bool yuv = frame.model == ColorModel::Yuv;
  const std::uint32_t space = picture.colorspace;
  std::uint32_t encoding = V4L2_MAP_YCBCR_ENC_DEFAULT(space);
  if (told && picture.ycbcr_enc != V4L2_YCBCR_ENC_DEFAULT) encoding = picture.ycbcr_enc;
  std::uint32_t range = V4L2_MAP_QUANTIZATION_DEFAULT(!yuv, space, encoding);
  if (told && picture.quantization != V4L2_QUANTIZATION_DEFAULT) range = picture.quantization;
  const bool depth = frame.components[0].bits > 8;
  frame.range = depth || range == V4L2_QUANTIZATION_FULL_RANGE ? ColorRange::Full : ColorRange::Limited;
  if (yuv) frame.matrix = matrixOf(encoding);
}

}  // namespace

const Format* findFormat(std::uint32_t fourcc) noexcept {
  const auto found = std::find_if(kFormats.begin(), kFormats.end(), [&](auto& f) { return f.fourcc == fourcc; });
  return found == kFormats.end() ? nullptr : &*found;
}

std::optional<std::uint32_t> fourccOf(std::string_view name) noexcept {
  if (name.empty() || name.size() > 4) return std::nullopt;
  std::array<char, 4> letters{' ', ' ', ' ', ' '};
  std::copy(name.begin(), name.end(), letters.begin());
  return v4l2_fourcc(letters[0], letters[1], letters[2], letters[3]);
}

Frame Layout::placeAt(const std::uint8_t* data) const noexcept {
  Frame placed = frame;
  for (std::size_t i = 0; i < placed.plane_count; ++i) placed.planes[i].data = data + plane_offsets[i];
  return placed;
}

std::optional<Layout> layoutOf(const Format& format, const v4l2_pix_format& picture) noexcept {
  constexpr std::uint32_t kLargest = 1U << 15;
  if (picture.width < 1 || picture.height < 1 || picture.width > kLargest || picture.height > kLargest) {
    return std::nullopt;
  }
  Layout layout;
  Frame& frame = layout.frame;
  frame.width = static_cast<int>(picture.width);
  frame.height = static_cast<int>(picture.height);
  if (!format.raw) return layout;
  frame.plane_count = 1;
  arrange(frame, format);
  signal(frame, picture);
  const int across = bytesAcross(format.fourcc, frame.width);
  const std::ptrdiff_t stride = picture.bytesperline == 0 ? across : static_cast<std::ptrdiff_t>(picture.bytesperline);
  if (stride < across || stride > 16 * std::ptrdiff_t{kLargest}) return std::nullopt;
  const std::ptrdiff_t plane = stride * frame.height;
  frame.planes[0].stride_bytes = stride;
  // The last row need not be padded.
  layout.bytes = static_cast<std::size_t>(plane - stride + across);
  if (frame.plane_count == 2) {
    const std::ptrdiff_t rows = (frame.height + 1) / 2;
    frame.planes[1].stride_bytes = stride;
    layout.plane_offsets[1] = plane;
    layout.bytes = static_cast<std::size_t>(plane + stride * (rows - 1) + (frame.width + 1) / 2 * 2);
  }
  return layout;
}

}  // namespace relievo::v4l2
