// SPDX-License-Identifier: Apache-2.0
// Cameras of Video4Linux, of depth and of colour, as a media source; and a decoder for their raw pictures.
#pragma once

#include <memory>

#include "hal/media_source.h"
#include "hal/video_decoder.h"

namespace relievo {

// Opens "v4l2:DEVICE[,FORMAT][,WIDTHxHEIGHT][@FPS]", such as "v4l2:/dev/video0,Z16,640x480@30"; FORMAT is a fourcc.
// Without one: Z16 where the camera has it, else the one that it is set to, else its first that is known here. What it
// cannot do it refuses: a picture of another size than was asked for is not taken.
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
[[nodiscard]] std::unique_ptr<VideoDecoder> makeV4l2Decoder();

}  // namespace relievo
