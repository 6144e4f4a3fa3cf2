// SPDX-License-Identifier: Apache-2.0
// Makes a Frame of a decoded buffer: a view of its memory.
#pragma once

#include <atomic>
#include <memory>

#include "drivers/gstreamer/objects.h"
#include "hal/media/frame.h"
#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo::gstreamer {

// Raw video in memory that this machine's processor reads, in every format that hal/media/frame.h can describe.
[[nodiscard]] CapsPtr readableCaps();

// How many buffers of an element's own pool are held by frames now.
using HeldCount = std::shared_ptr<std::atomic<int>>;

// The frame has no times. The stream's colour signalling is used, as the container and FFmpeg read it. With `copied`,
// the samples are copied and the buffer is free again. Unsupported if its layout is not readable.
[[nodiscard]] Result<Frame> frameOf(GstSample& sample, const StreamInfo& stream, const HeldCount& held, bool copied);

}  // namespace relievo::gstreamer
