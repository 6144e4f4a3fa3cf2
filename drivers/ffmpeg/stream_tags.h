// SPDX-License-Identifier: Apache-2.0
// Reads the tags inside a video stream (hal/media/stream_tags.h).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace relievo::ffmpeg {

using Bytes = std::span<const std::uint8_t>;

// The NAL units of a packet of H.264 or HEVC.
void eachUnit(const AVPacket& packet, const AVCodecParameters& parameters, const std::function<void(Bytes)>& visit);
void eachUnitByStartCode(Bytes data, const std::function<void(Bytes)>& visit);
// What the bytes of a unit mean: without its emulation prevention bytes.
[[nodiscard]] std::vector<std::uint8_t> withoutPrevention(Bytes bytes);

// The streams of a container that may carry tags, by index; none if the container has tags of depth of its own.
[[nodiscard]] std::map<int, const AVStream*> streamsWithTags(const AVFormatContext& container);

// The tags in `packet`, a key frame; keys in upper case. Of two views in two layers also kLayersTag. Empty if there are
// none, and for other codecs.
[[nodiscard]] std::map<std::string, std::string> streamTags(const AVPacket& packet,
                                                            const AVCodecParameters& parameters);

}  // namespace relievo::ffmpeg
