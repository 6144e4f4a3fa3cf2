// SPDX-License-Identifier: Apache-2.0
// What the two decoders share: a stream's parameters and its packets, as the library wants them.
#pragma once

#include "drivers/ffmpeg/library.h"
#include "hal/media_source.h"

namespace relievo::ffmpeg {

// Parameters of a stream that another back end's source has described. Null without memory.
[[nodiscard]] ParametersPtr parametersFromWords(const StreamInfo& stream, AVMediaType kind);

// By reference where the packet is the library's own; times in ns. `time_base` is that of the source's durations. False
// without memory.
[[nodiscard]] bool fillPacket(AVPacket& out, const Packet& packet, AVRational time_base);

}  // namespace relievo::ffmpeg
