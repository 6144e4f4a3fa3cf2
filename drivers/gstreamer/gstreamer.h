// SPDX-License-Identifier: Apache-2.0
// Video decoders that are GStreamer elements: stateless V4L2, VA-API, and those of vendors.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/media/video_decoder.h"

namespace relievo {

// Decodes H.264, HEVC, VP8, VP9, AV1 and MPEG-2 by a pipeline of a parser, a decoder and an end of its own. Without
// `element` the decoder is the hardware element of the highest rank that starts (GST_PLUGIN_FEATURE_RANK changes
// ranks); with it, that element, which may be software. `open` fails without one: NotFound if there is no hardware
// element for the codec, Unsupported if `element` is unknown, takes another codec, or gives fewer bits than the stream
// has, Io if no element starts.
//
// Frames refer to the element's own buffers, with dma-bufs if its memory is made of them. While the caller holds many
// pictures of a hardware element, whose buffers are few, they are copies. Held frames stay valid whatever happens to
// the decoder. When no more packets can be fed, or while draining, `receive` waits for the element: Lost if it has work
// and does nothing, or if its device has gone; Io if it fails (opening again may help); Unsupported if its pictures are
// not readable. Neither `close` nor `flush` waits long for an element that hangs. A packet without a time is
// Unsupported, since its picture could not be identified.
//
// The first `open` in a process loads GStreamer and its list of plugins, which may take seconds after an installation.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeGstreamerDecoder(std::string element = "");

// True if the machine has a device node that a hardware element could use. Does not load GStreamer.
[[nodiscard]] bool gstreamerHasDevices();

// The hardware elements, the highest rank first. Loads GStreamer.
struct GstreamerElement {
  std::string name, title;
};
[[nodiscard]] std::vector<GstreamerElement> lookAtGstreamerElements();

}  // namespace relievo
