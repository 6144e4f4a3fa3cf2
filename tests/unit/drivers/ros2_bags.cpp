// SPDX-License-Identifier: Apache-2.0
// Bags of ROS 2 that the test writes itself: MCAP in every packing, with and without a summary, and SQLite.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "app/media/registration/registration.h"
#include "tests/support/film/recording/recorded_frames.h"
#include "tests/support/film/recording/ros2_bags.h"
#include "tests/support/film/recording/ros_messages.h"
#include "tests/unit/drivers/rosbag_films.h"

namespace relievo::test {
namespace {

// As bags of ROS 1 in rosbag_test.cpp.
Ros2Recording recording() {
  Ros2Recording ros2;
  const auto imu = ros2.connect("/imu", "sensor_msgs/msg/Imu");
  const auto depth = ros2.connect("/camera/depth/image_raw", "sensor_msgs/msg/Image");
  const auto color = ros2.connect("/camera/color/image_raw", "sensor_msgs/msg/Image");
  for (int i = 0; i < 8; ++i) ros2.write(imu, kFirstStamp, "nothing");
  for (int i = 0; i < kPictures; ++i) {
    const std::int64_t recorded = kFirstStamp + i * kPeriod + 40 * kMs;
    ros2.write(depth, recorded, ros2Image(depthImage(i)));
    ros2.write(imu, recorded, "nothing");
    ros2.write(color, recorded + 5 * kMs, ros2Image(colorImage(i)));
  }
  return ros2;
}

Variant mcap(const char* name, McapForm form) {
  return {name, [form] { return mcapOf(recording(), form); }};
}
Variant db3(const char* name, bool log) {
  return {name, [log] { return db3Of(recording(), log); }};
}
const auto kMcap = testing::Values(
    mcap("mcap", {}), mcap("mcap_lz4", {.compression = "lz4"}), mcap("mcap_zstd", {.compression = "zstd"}),
    mcap("mcap_lz4_without_summary", {.compression = "lz4", .summary = false}),
    mcap("mcap_without_summary", {.summary = false}), mcap("mcap_without_index", {.index = false}),
    mcap("mcap_zstd_without_any", {.compression = "zstd", .summary = false, .index = false}),
    mcap("mcap_with_damaged_summary", {.index = false, .damaged = true}),
    mcap("mcap_without_chunks", {.chunks = false}), mcap("mcap_without_all", {.chunks = false, .summary = false}));
INSTANTIATE_TEST_SUITE_P(Ros2, RosbagVariants, kMcap, nameOf);
INSTANTIATE_TEST_SUITE_P(Ros2, RosbagCutOff, kMcap, nameOf);
INSTANTIATE_TEST_SUITE_P(Ros2Sqlite, RosbagVariants, testing::Values(db3("db3", false), db3("db3_with_log", true)),
                         nameOf);

TEST_F(RosbagSource, Ros2CamerasRegisterTheDepth) {
  constexpr std::array<double, 4> kUpright{0, 0, 0, 1};
  Ros2Recording ros2;
  BagImage z = depthImage(0), picture = colorImage(0);
  z.frame = "depth_optical", picture.frame = "color_optical_frame";  // texts of several lengths move what is behind
  const BagCamera depth{.cols = kCols, .rows = kRows, .focal_x = 30, .focal_y = 31, .center_x = 12, .center_y = 8};
  BagCamera color{.cols = kCols, .rows = kRows, .focal_x = 50, .focal_y = 51, .center_x = 11, .center_y = 7};
  color.distortion = {.1, .2, .01, .02, .3};
  ros2.write(ros2.connect("/cam/depth/image_raw", "sensor_msgs/msg/Image"), 1, ros2Image(z));
  ros2.write(ros2.connect("/cam/color/image_raw", "sensor_msgs/msg/Image"), 1, ros2Image(picture));
  ros2.write(ros2.connect("/cam/depth/camera_info", "sensor_msgs/msg/CameraInfo"), 1, ros2CameraInfo(depth));
  ros2.write(ros2.connect("/cam/color/camera_info", "sensor_msgs/msg/CameraInfo"), 1, ros2CameraInfo(color));
  const auto frames = ros2.connect("/tf_static", "tf2_msgs/msg/TFMessage");
  ros2.write(frames, 1, ros2FrameMotion("base_link", "depth_optical", {.1, 0, 0}, kUpright));
  ros2.write(frames, 1, ros2FrameMotion("base_link", "color_optical_frame", {.1, .03, 0}, kUpright));
  for (const std::string& bag : {mcapOf(ros2, {}), db3Of(ros2)}) {
    const auto source = open(bag);
    const StreamInfo* const stream = streamOf(*source, "/cam/depth/image_raw");
    ASSERT_NE(stream, nullptr);
    const auto& tags = stream->tags;
    ASSERT_TRUE(tags.contains("DEPTH_REGISTRATION"));
    const auto read = parseRegistration(tags.at("DEPTH_REGISTRATION"));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_NEAR(read->translation_mm[1], -30, 1e-6);
    EXPECT_EQ(read->depth.focal_y, 31);
    EXPECT_EQ(read->color.center_y, 7);
    EXPECT_EQ(read->color.distortion[4], .3);
  }
}

TEST_F(RosbagSource, Ros2PackedPicturesAreRead) {
  Ros2Recording ros2;
  const std::string jpeg = "\xff\xd8 and so on";
  ros2.write(ros2.connect("/color/compressed", "sensor_msgs/msg/CompressedImage"), 1,
             ros2CompressedImage(kFirstStamp, "rgb8; jpeg compressed bgr8", jpeg));
  ros2.write(ros2.connect("/depth/image_raw", "sensor_msgs/msg/Image"), 1, ros2Image(depthImage(0)));
  const auto source = open(mcapOf(ros2, {}));
  const StreamInfo color = *streamOf(*source, "/color/compressed");
  EXPECT_EQ(color.codec, "mjpeg");
  for (auto packet = source->read(); packet && *packet; packet = source->read()) {
    if ((*packet)->stream != color.index) continue;
    EXPECT_EQ(std::string((*packet)->data, (*packet)->data + (*packet)->bytes), jpeg);
  }
}

TEST_F(RosbagSource, Ros2TimesThatNoClockHasAreBounded) {
  constexpr std::int64_t kBeforeAll = std::numeric_limits<std::int64_t>::min();  // in MCAP behind all
  constexpr Duration kSecond = std::chrono::seconds(1), kLatest = std::chrono::seconds(0xFFFFFFFF);
  Ros2Recording ros2;
  BagImage unstamped = depthImage(0);
  unstamped.stamp_ns = 0;
  const auto topic = ros2.connect("/depth/image_raw", "sensor_msgs/msg/Image");
  const auto lastOf = [&](const std::string& bag) {
    const auto source = open(bag);
    MediaTime last{};
    for (auto packet = source->read(); packet && *packet; packet = source->read()) last = *(*packet)->pts;
    return last.time_since_epoch();
  };
  ros2.write(topic, kSecond.count(), ros2Image(unstamped));
  ros2.write(topic, kBeforeAll, ros2Image(unstamped));
  EXPECT_EQ(lastOf(db3Of(ros2)), -kSecond);
  EXPECT_EQ(lastOf(mcapOf(ros2, {})), kLatest - kSecond);
}

TEST_F(RosbagSource, Ros2PicturesBehindAMillionOtherMessagesAreRead) {
  const auto source = open(db3Of(recording(), false,
                                 "WITH n(i) AS (VALUES(1) UNION ALL SELECT i + 1 FROM n WHERE i < 1048576) "
                                 "INSERT INTO messages SELECT -i, 1, 0, x'' FROM n"));
  EXPECT_NE(streamOf(*source, "/camera/depth/image_raw"), nullptr);
}

// The rows of a made-up database can share the pages of one long name.
TEST_F(RosbagSource, TopicsWithLongerNamesThanAnyRecorderWritesArePassedOver) {
  for (const std::size_t length : {4000U, 5000U}) {
    Ros2Recording ros2;
    const auto topic = ros2.connect("/depth/" + std::string(length, 'x'), "sensor_msgs/msg/Image");
    ros2.write(topic, 1, ros2Image(depthImage(0)));
    for (const std::string& bag : {mcapOf(ros2, {}), db3Of(ros2)}) EXPECT_EQ(openingOf(bag).has_value(), length < 4096);
  }
}

TEST_F(RosbagSource, ADatabaseWhoseTableIsAQueryIsRefused) {
  const std::string views =
      db3Of(recording(), false, "ALTER TABLE messages RENAME TO m; CREATE VIEW messages AS SELECT * FROM m");
  EXPECT_THAT(openingOf(views).error().message, testing::HasSubstr("it lacks the tables topics and messages"));
}

TEST_F(RosbagSource, ADatabaseOfAnotherProgramIsRefused) {
  Ros2Recording empty;
  EXPECT_EQ(openingOf(db3Of(empty)).error().code, ErrorCode::Corrupt);
  EXPECT_EQ(openingOf("SQLite format 3\0 and then other bytes").error().code, ErrorCode::Unsupported);
  EXPECT_EQ(openingOf("\x89MCAP1\r\n").error().code, ErrorCode::Unsupported);
  std::string big_endian = mcapOf(recording(), {});
  for (std::size_t at = 0; (at = big_endian.find(std::string("\0\1\0\0", 4), at)) != big_endian.npos; ++at)
    big_endian[at + 1] = '\0';
  EXPECT_FALSE(openingOf(big_endian)) << "CDR of big endian";
}

}  // namespace
}  // namespace relievo::test
