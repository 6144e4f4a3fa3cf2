// SPDX-License-Identifier: Apache-2.0
// Which decoders GStreamer has.
#pragma once

#include <string>
#include <vector>

#include "drivers/gstreamer/coding.h"
#include "platform/error.h"

namespace relievo::gstreamer {

// Loads GStreamer, once in a process. Io if it cannot be.
[[nodiscard]] Result<void> load();

// The factories to try, the best first: hardware alone, or the one of that name. Only those that give pictures of as
// many bits as the stream has (0: unknown): others would lose some, or write beyond their buffers (libde265dec).
[[nodiscard]] Result<std::vector<FactoryPtr>> decodersFor(const Coding& coding, int bits, const std::string& element);

[[nodiscard]] bool isHardware(GstElementFactory& factory) noexcept;

}  // namespace relievo::gstreamer
