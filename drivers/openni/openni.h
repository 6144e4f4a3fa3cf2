// SPDX-License-Identifier: Apache-2.0
// Media source for recordings of OpenNI 1 and 2 (.oni): Kinect, Xtion, PrimeSense, Astra.
#pragma once

#include <memory>
#include <string>

#include "hal/media/media_source.h"

namespace relievo {

// True for a regular file that begins like a recording of any version.
[[nodiscard]] bool isOpenni(const std::string& path);

// Reads the format itself: OpenNI's own library seeks and decodes in threads that wait without end, and reads beyond
// its buffers in a damaged file.
//
// A recording with tables of its pictures is opened from them; one without (it was cut off, or is from before OpenNI
// 1.5) is scanned from record to record, without reading the pictures. Neither is ever read whole.
//
// Depth, colour and infrared are a stream each, with the tag TITLE. Depth and colour are Video, infrared is Other.
// Depth has the tags DEPTH_UNIT and DEPTH_INVALID. Its pictures are given out as "rawvideo" in gray16le, whether they
// are packed (16z, with or without a table) or plain; colour is "rawvideo" or "mjpeg". All are key frames. Times are
// those of the recording, from its first picture on. A damaged picture is left out.
//
// Refused: recordings without pictures, other versions of the format, depth that is cropped or in the sensor's raw
// shifts, and depth in another packing.
[[nodiscard]] std::unique_ptr<MediaSource> makeOpenniSource();

}  // namespace relievo
