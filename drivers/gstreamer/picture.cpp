// SPDX-License-Identifier: Apache-2.0
// GStreamer describes a format as hal/media/frame.h does: by plane, offset, step, shift and depth of each component.
#include "drivers/gstreamer/picture.h"

#include <gst/allocators/gstdmabuf.h>
#include <gst/video/video.h>

#include <algorithm>
#include <utility>

namespace relievo::gstreamer {
namespace {

constexpr const char* kUnreadable = "the GStreamer element's pictures have a layout that cannot be read";
constexpr const char* kTooLarge = "its pictures have grown to over 16.7 million samples; scale the film down";
constexpr std::int64_t kMostSamples = std::int64_t{1} << 24;  // VideoDecoder::kMostSamples

bool readableInPlace(const GstVideoFormatInfo& format, guint i) noexcept {
  const guint depth = GST_VIDEO_FORMAT_INFO_DEPTH(&format, i), shift = GST_VIDEO_FORMAT_INFO_SHIFT(&format, i);
  const gint step = GST_VIDEO_FORMAT_INFO_PSTRIDE(&format, i);
  if (depth == 8) return shift == 0 && step > 0;
  return depth > 8 && depth + shift <= 16 && step > 0 && step % 2 == 0 && GST_VIDEO_FORMAT_INFO_IS_LE(&format) != 0;
}

// Without alpha, which comes last.
guint componentCount(const GstVideoFormatInfo& format) noexcept {
  return GST_VIDEO_FORMAT_INFO_IS_GRAY(&format) != 0 ? 1 : 3;
}

bool describable(const GstVideoFormatInfo& format) noexcept {
  constexpr unsigned kOther =
      GST_VIDEO_FORMAT_FLAG_COMPLEX | GST_VIDEO_FORMAT_FLAG_PALETTE | GST_VIDEO_FORMAT_FLAG_TILED;
  const guint count = componentCount(format);
  if ((format.flags & kOther) != 0 || format.n_components < count) return false;
  for (guint i = 0; i < count; ++i) {
    if (!readableInPlace(format, i)) return false;
  }
  return true;
}

// A buffer of the element that a frame refers to.
class HeldBuffer {
 public:
  HeldBuffer(const GstVideoFrame& frame, HeldCount count) noexcept : frame_(frame), count_(std::move(count)) {
    ++*count_;
  }
  ~HeldBuffer() {
    gst_video_frame_unmap(&frame_);
    --*count_;
  }
  HeldBuffer(const HeldBuffer&) = delete;
  HeldBuffer& operator=(const HeldBuffer&) = delete;

 private:
  GstVideoFrame frame_;
  HeldCount count_;
};

ColorModel modelOf(const GstVideoFormatInfo& format) noexcept {
  if (GST_VIDEO_FORMAT_INFO_IS_GRAY(&format) != 0) return ColorModel::Gray;
  return GST_VIDEO_FORMAT_INFO_IS_RGB(&format) != 0 ? ColorModel::Rgb : ColorModel::Yuv;
}

void describe(Frame& frame, const GstVideoFrame& mapped) noexcept {
  const GstVideoFormatInfo& format = *mapped.info.finfo;
  frame.width = GST_VIDEO_FRAME_WIDTH(&mapped);
  frame.height = GST_VIDEO_FRAME_HEIGHT(&mapped);
  frame.model = modelOf(format);
  const guint count = componentCount(format);
  if (count > 1) {
    frame.chroma_shift_x = static_cast<std::uint8_t>(GST_VIDEO_FORMAT_INFO_W_SUB(&format, 1));
    frame.chroma_shift_y = static_cast<std::uint8_t>(GST_VIDEO_FORMAT_INFO_H_SUB(&format, 1));
  }
  for (guint i = 0; i < count; ++i) {
    frame.components[i] = {.plane = static_cast<std::uint8_t>(GST_VIDEO_FORMAT_INFO_PLANE(&format, i)),
                           .offset_bytes = static_cast<std::uint8_t>(GST_VIDEO_FORMAT_INFO_POFFSET(&format, i)),
                           .step_bytes = static_cast<std::uint8_t>(GST_VIDEO_FORMAT_INFO_PSTRIDE(&format, i)),
                           .shift = static_cast<std::uint8_t>(GST_VIDEO_FORMAT_INFO_SHIFT(&format, i)),
                           .bits = static_cast<std::uint8_t>(GST_VIDEO_FORMAT_INFO_DEPTH(&format, i))};
  }
  frame.plane_count = static_cast<std::uint8_t>(GST_VIDEO_FRAME_N_PLANES(&mapped));
  for (std::size_t i = 0; i < frame.plane_count; ++i) {
    frame.planes[i] = {static_cast<const std::uint8_t*>(mapped.data[i]), mapped.info.stride[i]};
  }
}

void signal(Frame& frame, const GstVideoFrame& mapped, const StreamInfo& stream) noexcept {
  frame.range = stream.range;
  if (frame.range == ColorRange::Unspecified && frame.model != ColorModel::Yuv) frame.range = ColorRange::Full;
  frame.matrix = stream.matrix;
  frame.primaries = stream.primaries;
  frame.transfer = stream.transfer;
  frame.sample_aspect = stream.sample_aspect;
  frame.interlaced = GST_VIDEO_FRAME_IS_INTERLACED(&mapped) != 0;
  frame.top_field_first = !frame.interlaced || GST_VIDEO_FRAME_IS_TFF(&mapped) != 0;
}

// Frame packing SEI of H.264 and HEVC, which the parser reads.
ViewLayout viewsOf(const GstVideoInfo& info) noexcept {
  const auto mode = GST_VIDEO_INFO_MULTIVIEW_MODE(&info);
  const bool right = (GST_VIDEO_INFO_MULTIVIEW_FLAGS(&info) & GST_VIDEO_MULTIVIEW_FLAGS_RIGHT_VIEW_FIRST) != 0;
  switch (mode) {
    case GST_VIDEO_MULTIVIEW_MODE_NONE:
    case GST_VIDEO_MULTIVIEW_MODE_MONO:
      return {};
    case GST_VIDEO_MULTIVIEW_MODE_SIDE_BY_SIDE:
      return {ViewLayout::Way::SideBySide, right};
    case GST_VIDEO_MULTIVIEW_MODE_TOP_BOTTOM:
      return {ViewLayout::Way::TopBottom, right};
    default:
      return {ViewLayout::Way::Other, right};
  }
}

// Memory that is a dma-buf and mapped as plain raw video is linear.
void addDmaBufs(Frame& frame, const GstVideoFrame& mapped) noexcept {
  for (std::size_t i = 0; i < frame.plane_count; ++i) {
    guint memory = 0, count = 0;
    gsize skip = 0;
    if (gst_buffer_find_memory(mapped.buffer, mapped.info.offset[i], 1, &memory, &count, &skip) != TRUE) continue;
    GstMemory* const m = gst_buffer_peek_memory(mapped.buffer, memory);
    if (gst_is_dmabuf_memory(m) == TRUE) {
      frame.dma_bufs[i] = {gst_dmabuf_memory_get_fd(m), static_cast<std::uint32_t>(m->offset + skip)};
    }
  }
}

// The visible part, if the element leaves cropping to its reader.
Frame visiblePart(const Frame& frame, GstBuffer& buffer) noexcept {
  const GstVideoCropMeta* const cut = gst_buffer_get_video_crop_meta(&buffer);
  if (cut == nullptr) return frame;
  const auto width = static_cast<guint>(frame.width), height = static_cast<guint>(frame.height);
  const bool inside = cut->width > 0 && cut->height > 0 && cut->x < width && cut->y < height &&
                      cut->width <= width - cut->x && cut->height <= height - cut->y;
  const bool aligned = ((cut->x >> frame.chroma_shift_x) << frame.chroma_shift_x) == cut->x &&
                       ((cut->y >> frame.chroma_shift_y) << frame.chroma_shift_y) == cut->y;
  if (!inside || !aligned) return frame;
  return crop(frame, static_cast<int>(cut->x), static_cast<int>(cut->y), static_cast<int>(cut->width),
              static_cast<int>(cut->height));
}

}  // namespace

CapsPtr readableCaps() {
  guint count = 0;
  const GstVideoFormat* const formats = gst_video_formats_raw(&count);
  GValue names = G_VALUE_INIT;
  g_value_init(&names, GST_TYPE_LIST);
  for (guint i = 0; i < count; ++i) {
    if (!describable(*gst_video_format_get_info(formats[i]))) continue;
    GValue name = G_VALUE_INIT;
    g_value_init(&name, G_TYPE_STRING);
    g_value_set_static_string(&name, gst_video_format_to_string(formats[i]));
    gst_value_list_append_and_take_value(&names, &name);
  }
  CapsPtr caps(gst_caps_new_empty_simple("video/x-raw"));
  gst_caps_set_value(caps.get(), "format", &names);
  g_value_unset(&names);
  return caps;
}

Result<Frame> frameOf(GstSample& sample, const StreamInfo& stream, const HeldCount& held, bool copied) {
  GstCaps* const caps = gst_sample_get_caps(&sample);
  GstBuffer* const buffer = gst_sample_get_buffer(&sample);
  GstVideoInfo info;
  if (caps == nullptr || buffer == nullptr || gst_video_info_from_caps(&info, caps) != TRUE ||
      !describable(*info.finfo)) {
    return fail(ErrorCode::Unsupported, kUnreadable);
  }
  if (std::int64_t{info.width} * info.height > kMostSamples) return fail(ErrorCode::Unsupported, kTooLarge);
  const BufferPtr copy(copied ? gst_buffer_copy_deep(buffer) : nullptr);
  GstVideoFrame mapped;
  if (gst_video_frame_map(&mapped, &info, copied ? copy.get() : buffer, GST_MAP_READ) != TRUE) {
    return fail(ErrorCode::Unsupported, kUnreadable);
  }
  Frame frame;
  frame.owner = std::make_shared<HeldBuffer>(mapped, copied ? std::make_shared<std::atomic<int>>(0) : held);
  describe(frame, mapped);
  signal(frame, mapped, stream);
  frame.views = viewsOf(info);
  addDmaBufs(frame, mapped);
  return visiblePart(frame, *mapped.buffer);
}

}  // namespace relievo::gstreamer
