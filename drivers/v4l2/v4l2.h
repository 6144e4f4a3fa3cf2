// SPDX-License-Identifier: Apache-2.0
// Video4Linux: a media source for depth and colour cameras, a decoder for their raw pictures, and a hardware video
// decoder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/media/media_source.h"
#include "hal/media/video_decoder.h"

namespace relievo {

// A source: opens "v4l2:DEVICE[,FORMAT][,WIDTHxHEIGHT][@FPS]", such as "v4l2:/dev/video0,Z16,640x480@30"; FORMAT is a
// fourcc. The default is Z16 if the camera has it, else its current format if supported, else its first supported one.
// A format or size that the camera does not have is an error.
//
//   depth   Z16 (distances: calibration tags say 1 mm, code 0 no value, 300 to 3000 mm), Y16, Y12, Y10
//   colour  YUYV, UYVY, NV12, RGB3, BGR3, GREY; MJPG, JPEG and H264, which need another decoder
//
// A depth camera is a film of two tracks: its depth, signalled as such, and the same depth as a gray picture, near is
// bright.
// It is a live source (`live`): times are the driver's, monotonic; `arrival` is when the first picture was taken.
// `missedPictures` counts lost pictures: gaps in the camera's sequence numbers, damaged or short buffers, times that do
// not increase. A read returns Timeout after three seconds without a picture; an unplugged camera is Lost. It cannot
// seek.
[[nodiscard]] std::unique_ptr<MediaSource> makeV4l2Source();

// True for a raw stream of the source above, which the decoder below takes.
[[nodiscard]] bool isV4l2Raw(const StreamInfo& stream) noexcept;

// Frames refer to the camera's own memory, with its dma-buf if the driver exports one. While the camera has few buffers
// left, the source returns copies instead, so that held pictures do not stop it.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeV4l2RawDecoder();

// Decodes H.264 and HEVC, 8-bit 4:2:0, in hardware: uses the first free node of /dev that takes the stream and its
// size, by the kernel's "Memory-to-memory Stateful Video Decoder Interface". `open` fails without one: NotFound without
// such hardware, else Unsupported or Io.
//
// Frames refer to the driver's own buffers, with dma-bufs if it exports them, or are copies while it has few left. Held
// frames stay valid whatever happens to the decoder. When no more packets can be fed, or while draining, `receive`
// waits for the hardware: Timeout if it has work and does nothing, Io if it fails (opening again may help after both),
// Lost if it has gone. A packet without a time is Unsupported, since its picture could not be identified.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeV4l2M2mDecoder();

struct V4l2M2mNode {
  std::string path, card;
  std::vector<std::string> codecs;
};
[[nodiscard]] std::vector<V4l2M2mNode> lookAtV4l2M2mNodes();

}  // namespace relievo
