// SPDX-License-Identifier: Apache-2.0
// Bags that the test writes itself: RealSense's layout, and cameras that register the depth to the colour.
#include <gtest/gtest.h>

#include <array>
#include <chrono>

#include "app/media/registration/registration.h"
#include "tests/support/film/recording/bag_writer.h"
#include "tests/support/film/recording/recorded_frames.h"
#include "tests/support/film/recording/ros_messages.h"
#include "tests/unit/drivers/rosbag_films.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;

// RealSense's layout: mono16 is depth, 16UC1 and 8UC1 are infrared, and stamps may come from two clocks.
std::string realSenseBag(std::int64_t color_clock_ns, float unit_m) {
  BagWriter bag("lz4");
  const std::string device = "/device_0/sensor_0/";
  const auto unit = bag.connect(device + "option/Depth_Units/value", "std_msgs/Float32");
  const auto infrared = bag.connect(device + "Infrared_1/image/data", "sensor_msgs/Image");
  const auto depth = bag.connect(device + "Depth_0/image/data", "sensor_msgs/Image");
  const auto color = bag.connect("/device_0/sensor_1/Color_0/image/data", "sensor_msgs/Image");
  bag.write(unit, 0, ByteWriter().add(0.0001F).bytes());
  for (int i = 0; i < kPictures; ++i) {
    BagImage z = depthImage(i), light = depthImage(i), picture = colorImage(i, "bgr8");
    z.encoding = "mono16";
    z.unit_m = unit_m;
    light.encoding = "16UC1";
    picture.stamp_ns += color_clock_ns;
    const std::int64_t recorded = 1000 * kMs + i * 33 * kMs;  // since the device was started
    bag.write(infrared, recorded, bagImage(light));
    bag.write(depth, recorded, bagImage(z));
    bag.write(color, recorded + 4 * kMs, bagImage(picture));
  }
  return bag.finish();
}

TEST_F(RosbagSource, RealSensesInfraredIsNotDepth) {
  const auto source = open(realSenseBag(0, 0.00025F));
  EXPECT_EQ(streamOf(*source, "/device_0/sensor_0/Infrared_1/image/data")->kind, StreamKind::Other);
  EXPECT_EQ(streamOf(*source, "/device_0/sensor_1/Color_0/image/data")->kind, StreamKind::Video);
  const StreamInfo depth = *streamOf(*source, "/device_0/sensor_0/Depth_0/image/data");
  EXPECT_EQ(depth.kind, StreamKind::Video);
  EXPECT_EQ(depth.tags.at("DEPTH_UNIT"), "0.250000") << "the picture's own unit";
  expectDepth(framesOf(*source, depth));
}

// PX4's simulated drone iris.
TEST_F(RosbagSource, AnIrisIsNotInfrared) {
  BagWriter bag("none");
  const auto depth = bag.connect("/iris_0/camera/depth/image_raw", "sensor_msgs/Image");
  const auto color = bag.connect("/iris_0/camera/color/image_raw", "sensor_msgs/Image");
  const auto infrared = bag.connect("/iris_0/camera/ir_left/image_raw", "sensor_msgs/Image");
  for (int i = 0; i < kPictures; ++i) {
    bag.write(infrared, 1000 * kMs + i * 33 * kMs, bagImage(depthImage(i)));
    bag.write(depth, 1000 * kMs + i * 33 * kMs, bagImage(depthImage(i)));
    bag.write(color, 1000 * kMs + i * 33 * kMs, bagImage(colorImage(i, "bgr8")));
  }
  const auto source = open(bag.finish());
  EXPECT_EQ(streamOf(*source, "/iris_0/camera/depth/image_raw")->kind, StreamKind::Video);
  EXPECT_EQ(streamOf(*source, "/iris_0/camera/color/image_raw")->kind, StreamKind::Video);
  EXPECT_EQ(streamOf(*source, "/iris_0/camera/ir_left/image_raw")->kind, StreamKind::Other);
}

TEST_F(RosbagSource, RealSensesOptionIsTheUnitOfOldRecordings) {
  const auto source = open(realSenseBag(0, 0));
  const StreamInfo depth = *streamOf(*source, "/device_0/sensor_0/Depth_0/image/data");
  EXPECT_EQ(depth.tags.at("DEPTH_UNIT"), "0.100000");
}

TEST_F(RosbagSource, StampsOfTwoClocksGiveWayToTheTimesOfRecording) {
  const auto source = open(realSenseBag(3600 * 1000 * kMs, 0.001F));
  const auto frames = framesOf(*source, StreamInfo(*streamOf(*source, "/device_0/sensor_0/Depth_0/image/data")));
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kPictures));
  for (int i = 0; i < kPictures; ++i) EXPECT_EQ(frames[static_cast<std::size_t>(i)].pts, MediaTime(i * 33ms));
}

constexpr double kHalf = 0.70710678118654752;  // sine and cosine of 45 degrees
constexpr std::array<double, 4> kUpright{0, 0, 0, 1}, kQuarterTurn{0, 0, kHalf, kHalf};

const BagCamera kDepthCamera{.cols = kCols, .rows = kRows, .focal_x = 30, .focal_y = 31, .center_x = 11, .center_y = 8};
BagCamera colorCamera(const std::string& model) {
  return {.cols = 2 * kCols,
          .rows = 2 * kRows,
          .focal_x = 60,
          .focal_y = 61,
          .center_x = 23,
          .center_y = 16,
          .model = model,
          .distortion = {0.1, -0.2, 0.001, 0.002, 0.03},
          .projection = {55, 0, 22, 0, 0, 56, 15, 0, 0, 0, 1, 0}};
}

// Points of a reference go to the depth camera by 10 mm, to the colour camera by a quarter turn and (50, 20, 0) mm:
// from depth to colour by the turn and (50, 20, 0) - turned (10, 0, 0).
TEST_F(RosbagSource, RealSensesCamerasRegisterTheDepth) {
  for (const char* const reference : {"0", "1"}) {
    BagWriter bag;
    const std::string depth = "/device_0/sensor_0/Depth_0", color = "/device_0/sensor_1/Color_0";
    BagImage z = depthImage(0);
    z.encoding = "mono16";
    z.unit_m = 0.0005F;
    bag.write(bag.connect(depth + "/image/data", "sensor_msgs/Image"), 1, bagImage(z));
    bag.write(bag.connect(color + "/image/data", "sensor_msgs/Image"), 1, bagImage(colorImage(0)));
    bag.write(bag.connect(depth + "/info/camera_info", "sensor_msgs/CameraInfo"), 1, bagCameraInfo(kDepthCamera));
    bag.write(bag.connect(color + "/info/camera_info", "sensor_msgs/CameraInfo"), 1,
              bagCameraInfo(colorCamera("Inverse Brown Conrady")));
    bag.write(bag.connect(depth + "/tf/0", "geometry_msgs/Transform"), 1, bagTransform({0.01, 0, 0}, kUpright));
    bag.write(bag.connect(color + "/tf/" + reference, "geometry_msgs/Transform"), 1,
              bagTransform({0.05, 0.02, 0}, kQuarterTurn));
    const auto source = open(bag.finish());
    const auto& tags = streamOf(*source, depth + "/image/data")->tags;
    const bool related = *reference == '0';
    ASSERT_EQ(tags.contains("DEPTH_REGISTRATION"), related) << "each camera's own reference relates nothing";
    if (!related) continue;
    const auto read = parseRegistration(tags.at("DEPTH_REGISTRATION"));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->depth.cols, kCols);
    EXPECT_EQ(read->depth.focal_y, 31);
    EXPECT_EQ(read->color.center_x, 23);
    EXPECT_EQ(read->color.distortion, (Lens::Coefficients{0.1, -0.2, 0.001, 0.002, 0.03, 0, 0, 0}));
    EXPECT_EQ(read->unit_mm, 0.5);
    EXPECT_NEAR(read->rotation[1], -1, 1e-9);
    EXPECT_NEAR(read->rotation[3], 1, 1e-9);
    EXPECT_NEAR(read->translation_mm[0], 50, 1e-6);
    EXPECT_NEAR(read->translation_mm[1], 10, 1e-6);
  }
}

// Both cameras hang on a base: the depth camera 100 mm to the right, the colour camera there and 30 mm lower, with a
// quarter turn.
TEST_F(RosbagSource, RosFramesRegisterTheDepth) {
  const auto tagsOf = [&](const std::string& lens, const std::string& color_frame, BagImage z = depthImage(0),
                          const std::string& color = "image_raw") {
    BagWriter bag;
    BagImage picture = colorImage(0);
    z.frame = "depth_optical";
    picture.frame = color_frame;
    bag.write(bag.connect("/cam/depth/image_raw", "sensor_msgs/Image"), 1, bagImage(z));
    bag.write(bag.connect("/cam/rgb/" + color, "sensor_msgs/Image"), 1, bagImage(picture));
    bag.write(bag.connect("/cam/depth/camera_info", "sensor_msgs/CameraInfo"), 1, bagCameraInfo(kDepthCamera));
    bag.write(bag.connect("/cam/rgb/camera_info", "sensor_msgs/CameraInfo"), 1, bagCameraInfo(colorCamera(lens)));
    const auto frames = bag.connect("/tf_static", "tf2_msgs/TFMessage");
    bag.write(frames, 1, bagFrameMotion("base", "depth_optical", {0.1, 0, 0}, kUpright));
    bag.write(frames, 1, bagFrameMotion("base", "/color_optical", {0.1, 0.03, 0}, kQuarterTurn));
    return streamOf(*open(bag.finish()), "/cam/depth/image_raw")->tags;
  };
  const auto tags = tagsOf("plumb_bob", "color_optical");
  ASSERT_TRUE(tags.contains("DEPTH_REGISTRATION"));
  const auto read = parseRegistration(tags.at("DEPTH_REGISTRATION"));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_NEAR(read->rotation[1], 1, 1e-9);
  EXPECT_NEAR(read->rotation[3], -1, 1e-9);
  EXPECT_NEAR(read->translation_mm[0], -30, 1e-6);
  EXPECT_NEAR(read->translation_mm[1], 0, 1e-6);
  EXPECT_EQ(read->unit_mm, 1);
  BagImage metres = depthImage(0);
  metres.encoding = "32FC1";
  metres.step = sizeof(float) * kCols;
  metres.data = std::string(sizeof(float) * kCols * kRows, '\0');
  const auto of_metres = parseRegistration(tagsOf("plumb_bob", "color_optical", metres).at("DEPTH_REGISTRATION"));
  ASSERT_TRUE(of_metres) << of_metres.error().message;
  EXPECT_EQ(of_metres->unit_mm, 1000);

  const auto rectified = parseRegistration(
      tagsOf("plumb_bob", "color_optical", depthImage(0), "image_rect_color").at("DEPTH_REGISTRATION"));
  ASSERT_TRUE(rectified) << rectified.error().message;
  EXPECT_EQ(rectified->color.focal_x, 55);
  EXPECT_EQ(rectified->color.focal_y, 56);
  EXPECT_EQ(rectified->color.center_x, 22);
  EXPECT_EQ(rectified->color.center_y, 15);
  EXPECT_EQ(rectified->color.distortion, Lens::Coefficients{});
  EXPECT_EQ(rectified->depth.focal_y, 31) << "which was not rectified";
  EXPECT_FALSE(tagsOf("equidistant", "color_optical").contains("DEPTH_REGISTRATION")) << "another lens model";
  EXPECT_FALSE(tagsOf("plumb_bob", "elsewhere").contains("DEPTH_REGISTRATION"));
  EXPECT_FALSE(tagsOf("plumb_bob", "depth_optical").contains("DEPTH_REGISTRATION")) << "in the colour's view already";
}

TEST_F(RosbagSource, OfTwoCamerasDepthAndColourAreOfTheSame) {
  BagWriter bag;
  const auto left_color = bag.connect("/left/rgb/image", "sensor_msgs/Image");
  const auto right_color = bag.connect("/right/rgb/image", "sensor_msgs/Image");
  const auto left_depth = bag.connect("/left/depth/image", "sensor_msgs/Image");
  const auto right_depth = bag.connect("/right/depth/image", "sensor_msgs/Image");
  for (int i = 0; i < kPictures; ++i) {
    for (const auto color : {left_color, right_color}) bag.write(color, kFirstStamp, bagImage(colorImage(i)));
    if (i > 2) bag.write(left_depth, kFirstStamp, bagImage(depthImage(i)));
    bag.write(right_depth, kFirstStamp, bagImage(depthImage(i)));
  }
  const auto source = open(bag.finish());
  for (const StreamInfo& stream : source->streams()) {
    const bool right = stream.tags.at("TITLE").starts_with("/right");
    EXPECT_EQ(stream.kind, right ? StreamKind::Video : StreamKind::Other) << stream.tags.at("TITLE");
  }
}

}  // namespace
}  // namespace relievo::test
