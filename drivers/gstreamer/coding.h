// SPDX-License-Identifier: Apache-2.0
// What GStreamer calls the codecs, and how it wants their streams described.
#pragma once

#include "drivers/gstreamer/objects.h"
#include "hal/media/media_source.h"

namespace relievo::gstreamer {

struct Coding {
  const char* codec;       // StreamInfo::codec
  const char* media_type;  // as decoders take it
  const char* packets;     // caps of whole packets that hold all parameter sets
  const char* parser;      // the element in front of the decoder, if it is installed
  const char* described;   // caps of packets whose parameter sets are in a container's description; null: no such form
};

// Null if no element can be expected to take it.
[[nodiscard]] const Coding* codingOf(const StreamInfo& stream) noexcept;

// The caps of the stream's packets.
[[nodiscard]] CapsPtr capsOf(const Coding& coding, const StreamInfo& stream);

// A packet's buffer, which refers to the packet's data. `pts`, `dts`: as in the pipeline.
[[nodiscard]] BufferPtr bufferOf(const Packet& packet, GstClockTime pts, GstClockTime dts);

}  // namespace relievo::gstreamer
