// SPDX-License-Identifier: Apache-2.0
// Media source for bags of ROS 1 (format 2.0) and ROS 2 (MCAP, SQLite): recordings of RealSense cameras and of ROS
// topics.
#pragma once

#include <memory>
#include <string>

#include "hal/media/media_source.h"

namespace relievo {

// True for a regular file that begins like a bag of any version.
[[nodiscard]] bool isRosbag(const std::string& path);

// Chunks may be plain, lz4, bz2 or zstd. A bag with an index is opened from it; one without (the recording was cut off)
// is scanned from record to record, without reading the pictures. Neither is ever read whole.
//
// Each topic of pictures (sensor_msgs/Image, sensor_msgs/CompressedImage) is a stream whose tag TITLE is the topic. One
// depth topic, and the colour topic nearest to it by name, are Video; all others are Other. Infrared takes the place of
// a missing colour. Depth has the tags DEPTH_UNIT and DEPTH_INVALID, and DEPTH_REGISTRATION (the TOML of
// app/media/registration/registration.h) if the bag has both cameras' parameters and how they stand to each other.
//
// Pictures are raw ("rawvideo" with StreamInfo::pixel_format), JPEG or PNG, all key frames. Their times are the
// messages' own stamps; the times of recording if a stamp is absent or the two streams' stamps come from different
// clocks. A damaged picture, or one of another size than the first, is left out.
//
// Refused: bags without pictures, other versions of the format, and messages of over 64 MiB. A chunk may be 128 MiB,
// of which one is unpacked at a time.
[[nodiscard]] std::unique_ptr<MediaSource> makeRosbagSource();

}  // namespace relievo
