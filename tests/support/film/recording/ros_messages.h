// SPDX-License-Identifier: Apache-2.0
// Messages as ROS 1 serialises them and as ROS 2 does (CDR), for tests.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace relievo::test {

struct BagImage {
  std::int64_t stamp_ns = 0;
  std::string frame = "camera";
  std::uint32_t cols = 0, rows = 0, step = 0;
  std::string encoding;
  bool big_endian = false;
  std::string data;
  float unit_m = 0;  // over 0: behind the picture, as RealSense writes it
};
[[nodiscard]] std::string bagImage(const BagImage& image);
[[nodiscard]] std::string bagCompressedImage(std::int64_t stamp_ns, std::string_view format, std::string_view data);
struct BagCamera {
  std::uint32_t cols = 0, rows = 0;
  double focal_x = 0, focal_y = 0, center_x = 0, center_y = 0;
  std::string model = "plumb_bob";
  std::vector<double> distortion = std::vector<double>(5);
  std::array<double, 12> projection{};  // of rectified pictures
};
[[nodiscard]] std::string bagCameraInfo(const BagCamera& camera);
// geometry_msgs/Transform; rotation: x, y, z, w.
[[nodiscard]] std::string bagTransform(const std::array<double, 3>& translation_m,
                                       const std::array<double, 4>& rotation);
// tf2_msgs/TFMessage with one transform.
[[nodiscard]] std::string bagFrameMotion(std::string_view parent, std::string_view child,
                                         const std::array<double, 3>& translation_m,
                                         const std::array<double, 4>& rotation);

// The same in CDR.
[[nodiscard]] std::string ros2Image(const BagImage& image);
[[nodiscard]] std::string ros2CompressedImage(std::int64_t stamp_ns, std::string_view format, std::string_view data);
[[nodiscard]] std::string ros2CameraInfo(const BagCamera& camera);
[[nodiscard]] std::string ros2FrameMotion(std::string_view parent, std::string_view child,
                                          const std::array<double, 3>& translation_m,
                                          const std::array<double, 4>& rotation);

}  // namespace relievo::test
