// SPDX-License-Identifier: Apache-2.0
// A valid bag with bytes changed: the first byte of the input chooses the bag, then each three bytes are a position and
// a value, and 0xffff cuts the bag off at the position before.
#include <array>

#include "drivers/rosbag/rosbag.h"
#include "tests/fuzz/film_fuzz.h"
#include "tests/support/film/recording/bag_writer.h"
#include "tests/support/film/recording/ros2_bags.h"
#include "tests/support/film/recording/ros_messages.h"

namespace relievo {
namespace {

std::string soundBag(const std::string& compression, bool indexed) {
  test::BagWriter bag(compression);
  const std::string device = "/device_0/sensor_0/";
  const auto depth = bag.connect(device + "Depth_0/image/data", "sensor_msgs/Image");
  const auto color = bag.connect(device + "Color_0/image/data", "sensor_msgs/Image");
  const auto unit = bag.connect(device + "option/Depth_Units/value", "std_msgs/Float32");
  bag.write(unit, 1, test::ByteWriter().add(0.001F).bytes());
  for (const char* const stream : {"Depth_0", "Color_0"}) {
    const auto info = bag.connect(device + stream + "/info/camera_info", "sensor_msgs/CameraInfo");
    const auto pose = bag.connect(device + stream + "/tf/0", "geometry_msgs/Transform");
    bag.write(info, 1,
              test::bagCameraInfo({.cols = 4, .rows = 3, .focal_x = 4, .focal_y = 4, .center_x = 2, .center_y = 1}));
    bag.write(pose, 1, test::bagTransform({0.1, 0, 0}, {0, 0, 0, 1}));
  }
  const auto frames = bag.connect("/tf", "tf2_msgs/TFMessage");
  bag.write(frames, 1, test::bagFrameMotion("base", "camera", {0, 0, 0}, {0, 0, 0, 1}));
  for (int i = 0; i < 4; ++i) {
    bag.write(
        depth, i,
        test::bagImage(
            {.stamp_ns = i + 1, .cols = 4, .rows = 3, .step = 8, .encoding = "mono16", .data = std::string(24, '\4')}));
    bag.write(
        color, i,
        test::bagImage(
            {.stamp_ns = i + 1, .cols = 4, .rows = 3, .step = 12, .encoding = "rgb8", .data = std::string(36, '\5')}));
    if (i == 1) bag.endChunk();
  }
  return bag.finish(indexed);
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  static const std::array<std::string, 8> kBags{
      soundBag("none", true),
      soundBag("none", false),
      soundBag("lz4", true),
      soundBag("bz2", false),
      test::mcapOf(test::depthOnRos2(), {}),
      test::mcapOf(test::depthOnRos2(), {.compression = "zstd", .summary = false}),
      test::mcapOf(test::depthOnRos2(), {.chunks = false}),
      test::db3Of(test::depthOnRos2())};
  if (size == 0) return 0;
  std::string bag = kBags[bytes[0] % kBags.size()];
  std::size_t place = bag.size();
  for (std::size_t i = 1; i + 2 < size; i += 3) {
    const std::size_t given = bytes[i] | std::size_t{bytes[i + 1]} << 8;
    if (given == 0xffff) bag.resize(std::min(bag.size(), place));
    if (bag.empty()) break;
    place = given % bag.size();
    bag[place] = static_cast<char>(bytes[i + 2]);
  }
  test::playBytes(std::span(reinterpret_cast<const std::uint8_t*>(bag.data()), bag.size()), makeRosbagSource);
  return 0;
}
