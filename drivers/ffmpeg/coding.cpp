// SPDX-License-Identifier: Apache-2.0
// Converts streams and packets to libavcodec's types.
#include "drivers/ffmpeg/coding.h"

#include <cstring>

extern "C" {
#include <libavcodec/codec_desc.h>
#include <libavutil/channel_layout.h>
#include <libavutil/pixdesc.h>
}

namespace relievo::ffmpeg {
namespace {

std::int64_t ticks(const std::optional<MediaTime>& time) noexcept {
  return time ? time->time_since_epoch().count() : AV_NOPTS_VALUE;
}

}  // namespace

ParametersPtr parametersFromWords(const StreamInfo& stream, AVMediaType kind) {
  ParametersPtr parameters(avcodec_parameters_alloc());
  if (!parameters) return nullptr;
  const AVCodecDescriptor* const codec = avcodec_descriptor_get_by_name(stream.codec.c_str());
  parameters->codec_type = kind;
  parameters->codec_id = codec == nullptr ? AV_CODEC_ID_NONE : codec->id;
  parameters->width = stream.width;
  parameters->height = stream.height;
  if (!stream.pixel_format.empty()) parameters->format = av_get_pix_fmt(stream.pixel_format.c_str());
  parameters->sample_rate = stream.sample_rate_hz;
  if (stream.channels > 0) av_channel_layout_default(&parameters->ch_layout, stream.channels);
  if (stream.extradata.empty()) return parameters;
  const std::size_t bytes = stream.extradata.size();
  parameters->extradata = static_cast<std::uint8_t*>(av_mallocz(bytes + AV_INPUT_BUFFER_PADDING_SIZE));
  if (parameters->extradata == nullptr) return nullptr;
  std::memcpy(parameters->extradata, stream.extradata.data(), bytes);
  parameters->extradata_size = static_cast<int>(bytes);
  return parameters;
}

bool fillPacket(AVPacket& out, const Packet& packet, AVRational time_base) {
  if (const auto* own = native<AVPacket, PacketDeleter>(packet.owner)) {
    if (av_packet_ref(&out, own) < 0) return false;
    out.duration = durationFrom(own->duration, time_base).count();
  } else {
    if (av_new_packet(&out, static_cast<int>(packet.bytes)) < 0) return false;
    std::memcpy(out.data, packet.data, packet.bytes);
    if (packet.keyframe) out.flags |= AV_PKT_FLAG_KEY;
  }
  out.pts = ticks(packet.pts);
  out.dts = ticks(packet.dts);
  return true;
}

}  // namespace relievo::ffmpeg
