// SPDX-License-Identifier: Apache-2.0
// Video4Linux: cameras, of depth and of colour, as a media source; a decoder for their raw pictures; and decoding by
// hardware.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/media_source.h"
#include "hal/video_decoder.h"

namespace relievo {

// A source: opens "v4l2:DEVICE[,FORMAT][,WIDTHxHEIGHT][@FPS]", such as "v4l2:/dev/video0,Z16,640x480@30"; FORMAT is a
// fourcc. Without one: Z16 where the camera has it, else the one that it is set to, else its first that is known here.
// What it cannot do it refuses: a picture of another size than was asked for is not taken.
//
//   depth   Z16 (distances: calibration tags say 1 mm, code 0 no value, 300 to 3000 mm), Y16, Y12, Y10
//   colour  YUYV, UYVY, NV12, RGB3, BGR3, GREY; MJPG, JPEG and H264 go to a decoder by those names
//
// A depth camera is a film of two tracks: its depth, signalled as such, and the same as a gray picture, near bright.
//
// A live source (`live`), at the camera's own pace: times are the driver's, monotonic; `arrival` is when the first
// picture was taken. A picture that was lost (a gap in the camera's count, a damaged or short buffer, a time that does
// not grow) is counted by `lost`. A read that brings no picture for three seconds returns Timeout; a camera that is
// pulled out is Lost. It cannot seek.
[[nodiscard]] std::unique_ptr<MediaSource> makeV4l2Source();

// Whether a stream is of the source above and raw: for the decoder below.
[[nodiscard]] bool isV4l2Raw(const StreamInfo& stream) noexcept;

// Hands the camera's own memory on, with its dma-buf where the driver exports one. While few buffers are left to the
// camera, the source hands out copies instead, so that who holds pictures does not stop it.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeV4l2RawDecoder();

// Decodes H.264 and HEVC, 8-bit 4:2:0, by hardware: the first free node of /dev that takes the stream and its size, by
// the kernel's "Memory-to-memory Stateful Video Decoder Interface". `open` fails where there is none: NotFound without
// such hardware, else Unsupported or Io.
//
// Pictures are the driver's own buffers, with their dma-bufs where it exports them; a copy where it has few left. Those
// that are held stay as they are whatever becomes of the decoder. Where packets can be fed no more, or are drained,
// `receive` waits for the hardware: Timeout when it has done nothing for a while that has work, Io when it cannot go on
// (both may end with a new `open`), Lost when it has gone. A packet without a time is Unsupported: there is nothing to
// tell its picture by.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeV4l2M2mDecoder();

struct V4l2M2mNode {
  std::string path, card;
  std::vector<std::string> codecs;
};
[[nodiscard]] std::vector<V4l2M2mNode> lookAtV4l2M2mNodes();

}  // namespace relievo
