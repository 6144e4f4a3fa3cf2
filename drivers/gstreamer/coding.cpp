// SPDX-License-Identifier: Apache-2.0
// Caps are as in GStreamer's "List of defined types".
#include "drivers/gstreamer/coding.h"

#include <algorithm>
#include <array>

namespace relievo::gstreamer {
namespace {

constexpr std::array kCodings{
    Coding{"h264", "video/x-h264", "video/x-h264, stream-format=byte-stream, alignment=au", "h264parse",
           "video/x-h264, stream-format=avc, alignment=au"},
    Coding{"hevc", "video/x-h265", "video/x-h265, stream-format=byte-stream, alignment=au", "h265parse",
           "video/x-h265, stream-format=hvc1, alignment=au"},
    Coding{"vp8", "video/x-vp8", "video/x-vp8", nullptr, nullptr},
    Coding{"vp9", "video/x-vp9", "video/x-vp9, alignment=super-frame", "vp9parse", nullptr},
    Coding{"av1", "video/x-av1", "video/x-av1, stream-format=obu-stream, alignment=tu", "av1parse",
           "video/x-av1, stream-format=obu-stream, alignment=tu"},
    Coding{"mpeg2video", "video/mpeg, mpegversion=2, systemstream=false",
           "video/mpeg, mpegversion=2, systemstream=false", "mpegvideoparse", nullptr},
};

// The descriptions of MP4 and Matroska begin with their version (ISO/IEC 14496-15; AV1 marks it with the highest bit);
// start codes begin with 0.
bool hasDescription(const StreamInfo& stream) noexcept {
  return !stream.extradata.empty() && (stream.extradata[0] == 1 || stream.extradata[0] == 0x81);
}

void letGo(gpointer owner) noexcept {
  delete static_cast<std::shared_ptr<const void>*>(owner);
}

}  // namespace

const Coding* codingOf(const StreamInfo& stream) noexcept {
  const auto* const found =
      std::find_if(kCodings.begin(), kCodings.end(), [&](const Coding& c) { return stream.codec == c.codec; });
  return found == kCodings.end() ? nullptr : found;
}

CapsPtr capsOf(const Coding& coding, const StreamInfo& stream) {
  const bool described = coding.described != nullptr && hasDescription(stream);
  CapsPtr caps(gst_caps_from_string(described ? coding.described : coding.packets));
  if (stream.width > 0 && stream.height > 0) {
    gst_caps_set_simple(caps.get(), "width", G_TYPE_INT, stream.width, "height", G_TYPE_INT, stream.height, nullptr);
  }
  if (described) {
    const std::size_t bytes = stream.extradata.size();
    const BufferPtr data(gst_buffer_new_memdup(stream.extradata.data(), bytes));
    gst_caps_set_simple(caps.get(), "codec_data", GST_TYPE_BUFFER, data.get(), nullptr);
  }
  return caps;
}

BufferPtr bufferOf(const Packet& packet, GstClockTime pts, GstClockTime dts) {
  auto* const owner = new std::shared_ptr<const void>(packet.owner);
  BufferPtr buffer(gst_buffer_new_wrapped_full(GST_MEMORY_FLAG_READONLY, const_cast<std::uint8_t*>(packet.data),
                                               packet.bytes, 0, packet.bytes, owner, letGo));
  GST_BUFFER_PTS(buffer.get()) = pts;
  GST_BUFFER_DTS(buffer.get()) = dts;
  if (!packet.keyframe) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DELTA_UNIT);
  return buffer;
}

}  // namespace relievo::gstreamer
