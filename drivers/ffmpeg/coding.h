// SPDX-License-Identifier: Apache-2.0
// Shared by the two decoders: converts a stream's parameters and its packets to libavcodec's types.
#pragma once

#include "drivers/ffmpeg/library.h"
#include "hal/media/media_source.h"

namespace relievo::ffmpeg {

// Parameters of a stream from another back end's source. Null if out of memory.
[[nodiscard]] ParametersPtr parametersFromWords(const StreamInfo& stream, AVMediaType kind);

// References the packet's data if it is FFmpeg's own, else copies it; times are in ns. `time_base`: of the source's
// durations. False if out of memory.
[[nodiscard]] bool fillPacket(AVPacket& out, const Packet& packet, AVRational time_base);

}  // namespace relievo::ffmpeg
