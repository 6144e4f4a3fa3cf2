// SPDX-License-Identifier: Apache-2.0
// The messages of ROS 1 and ROS 2 that describe pictures and cameras.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/rosbag/record.h"
#include "hal/media/media_time.h"

namespace relievo::rosbag {

// A serialised message: packed as by ROS 1, or as CDR in little endian (OMG DDS-RTPS 2.3, 10.2), as by ROS 2.
struct Message {
  std::vector<std::uint8_t> bytes;
  bool cdr = false;
};

// sensor_msgs/Image and sensor_msgs/CompressedImage.
struct PictureMessage {
  Duration stamp{0};
  std::string frame;                                 // the camera's coordinate frame
  std::uint32_t cols = 0, rows = 0, step_bytes = 0;  // of raw pictures
  std::string encoding;                              // of raw pictures; of compressed ones `format`
  bool compressed = false;
  bool big_endian = false;
  std::size_t data_begin = 0, data_bytes = 0;  // in the message
  std::optional<float> unit_m;                 // RealSense: of a depth code
};
[[nodiscard]] std::optional<PictureMessage> parsePicture(const Message& message, bool compressed);

// The stamp of any message that begins with a std_msgs/Header; of both serialisations.
[[nodiscard]] std::optional<Duration> parseStamp(Bytes message);

// sensor_msgs/CameraInfo. `intrinsics` is the matrix K, row by row, `projection` the matrix P of rectified pictures.
struct CameraMessage {
  std::uint32_t cols = 0, rows = 0;
  std::string model;
  std::vector<double> distortion;
  std::array<double, 9> intrinsics{};
  std::array<double, 12> projection{};
};
[[nodiscard]] std::optional<CameraMessage> parseCamera(const Message& message);

// A rigid motion: p -> rotation x p + translation, in metres.
struct Motion {
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  std::array<double, 3> translation_m{0, 0, 0};
};
[[nodiscard]] Motion inverse(const Motion& motion) noexcept;
// `first`, then `second`.
[[nodiscard]] Motion chain(const Motion& first, const Motion& second) noexcept;

// geometry_msgs/Transform. Nullopt unless its quaternion has the length 1.
[[nodiscard]] std::optional<Motion> parseTransform(const Message& message);

// tf2_msgs/TFMessage. `motion` maps points of the child's frame to the parent's.
struct FrameMotion {
  std::string parent, child;
  Motion motion;
};
[[nodiscard]] std::vector<FrameMotion> parseFrameMotions(const Message& message);

}  // namespace relievo::rosbag
