// SPDX-License-Identifier: Apache-2.0
// Bags that the test writes itself: ROS's own layout, every packing, cut off, without an index.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "drivers/rosbag/rosbag.h"
#include "tests/support/film/failing_disk.h"
#include "tests/support/film/recording/bag_writer.h"
#include "tests/support/film/recording/recorded_frames.h"
#include "tests/support/film/recording/ros_messages.h"
#include "tests/unit/drivers/rosbag_films.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;

struct RosTopics {
  std::string color = "/camera/color/image_raw", depth = "/camera/depth/image_raw";
};
// Colour and depth, three pictures of each in a chunk, after a chunk of other messages.
std::string rosBag(const std::string& compression = "none", bool indexed = true, const RosTopics& topics = {}) {
  BagWriter bag(compression);
  const auto imu = bag.connect("/imu", "sensor_msgs/Imu");
  const auto depth = bag.connect(topics.depth, "sensor_msgs/Image");
  const auto color = bag.connect(topics.color, "sensor_msgs/Image");
  bag.write(imu, kFirstStamp, "nothing");
  bag.endChunk();
  for (int i = 0; i < kPictures; ++i) {
    const std::int64_t recorded = kFirstStamp + i * kPeriod + 40 * kMs;
    bag.write(depth, recorded, bagImage(depthImage(i)));
    bag.write(imu, recorded, "nothing");
    bag.write(color, recorded + 5 * kMs, bagImage(colorImage(i)));
    if (i % 3 == 2) bag.endChunk();
  }
  return bag.finish(indexed);
}

Variant variant(const char* name, const char* compression, bool indexed) {
  return {name, [=] { return rosBag(compression, indexed); }};
}
const auto kRos1 =
    testing::Values(variant("plain", "none", true), variant("lz4", "lz4", true), variant("bz2", "bz2", true),
                    variant("plain_without_index", "none", false), variant("lz4_without_index", "lz4", false),
                    variant("bz2_without_index", "bz2", false));
INSTANTIATE_TEST_SUITE_P(Ros1, RosbagVariants, kRos1, nameOf);
INSTANTIATE_TEST_SUITE_P(Ros1, RosbagCutOff, kRos1, nameOf);

TEST_P(RosbagVariants, HoldsDepthAndColourToTheSample) {
  const std::string bag = GetParam().bag();
  const auto source = open(bag);
  ASSERT_EQ(source->streams().size(), 2u);
  const StreamInfo* const depth = streamOf(*source, "/camera/depth/image_raw");
  ASSERT_NE(depth, nullptr);
  EXPECT_EQ(depth->kind, StreamKind::Video);
  EXPECT_EQ(depth->bits, 16);
  EXPECT_EQ(depth->tags.at("DEPTH_UNIT"), "1.000000");
  EXPECT_EQ(depth->tags.at("DEPTH_INVALID"), "0+65535");
  EXPECT_EQ(depth->frame_period, Duration(kPeriod));
  EXPECT_EQ(source->duration(), Duration(kPictures * kPeriod + 5 * kMs));
  expectDepth(framesOf(*source, *depth));

  const auto again = open(bag);
  const auto colors = framesOf(*again, *streamOf(*again, "/camera/color/image_raw"));
  ASSERT_EQ(colors.size(), static_cast<std::size_t>(kPictures));
  EXPECT_EQ(colors[3].pts, MediaTime(Duration(3 * kPeriod + 5 * kMs)));
  for (const auto& [c, red, blue] : {std::array{3u, 255u, 0u}, std::array{4u, 0u, 255u}}) {
    EXPECT_EQ(sample(colors[0], c, 0, 0), red);
    EXPECT_EQ(sample(colors[0], c, 0, 2), blue);
  }
}

TEST_P(RosbagVariants, SeeksToThePictureAtOrBeforeTheTarget) {
  const auto source = open(GetParam().bag());
  const StreamInfo depth = *streamOf(*source, "/camera/depth/image_raw");
  for (const int picture : {7, 0, 11, 3, 2}) {
    ASSERT_TRUE(source->seek(MediaTime(Duration(picture * kPeriod + 6 * kMs))));
    expectDepth(framesOf(*source, depth), picture, kPictures - picture);
  }
  ASSERT_TRUE(source->seek(MediaTime(-1s)));
  expectDepth(framesOf(*source, depth));
}

// Cut at every 149th byte, and whole: the whole pictures before the cut are played, and then the film ends without an
// error.
TEST_P(RosbagCutOff, CutOffAnywhereItPlaysWhatIsWhole) {
  const std::string bag = GetParam().bag();
  std::size_t before = 0;
  for (std::size_t length = 0; length < bag.size() + 149; length += 149) {
    SCOPED_TRACE(length);
    const std::string path = save(bag.substr(0, length));
    saved_ = 0;
    const auto source = makeRosbagSource();
    if (!source->open(path)) {
      EXPECT_EQ(before, 0u);
      continue;
    }
    std::size_t pictures = 0;
    for (;;) {
      const auto packet = source->read();
      ASSERT_TRUE(packet);
      if (!*packet) break;
      ++pictures;
    }
    EXPECT_GE(pictures, before);
    before = pictures;
  }
  EXPECT_EQ(before, static_cast<std::size_t>(2 * kPictures));
}

TEST_P(RosbagVariants, IsLostWhenTheDiskFails) {
  const auto source = open(GetParam().bag());
  EXPECT_EQ(endOnFailingDisk(*source), ErrorCode::Lost);
}

TEST_F(RosbagSource, TakesBigEndianAndPaddedRows) {
  for (const Layout layout : {Layout{.big_endian = true}, Layout{.padding = 10}}) {
    BagWriter bag;
    const auto depth = bag.connect("/depth", "sensor_msgs/Image");
    for (int i = 0; i < kPictures; ++i) bag.write(depth, kFirstStamp, bagImage(depthImage(i, layout)));
    const auto source = open(bag.finish());
    expectDepth(framesOf(*source, source->streams()[0]));
  }
}

TEST_F(RosbagSource, FloatsAreMetres) {
  BagWriter bag;
  const auto depth = bag.connect("/depth", "sensor_msgs/Image");
  // The scale is that of the first picture that has a number.
  int written = 0;
  for (const float factor : {std::nanf(""), 0.0F, 1.0F}) {
    std::string data;
    for (const float metres : {0.5F, std::nanf(""), 2.2504F, 0.0F}) {
      const float value = metres * factor;
      data.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    const std::int64_t stamp = kFirstStamp + kPeriod * written++;
    bag.write(depth, stamp,
              bagImage({.stamp_ns = stamp, .cols = 2, .rows = 2, .step = 8, .encoding = "32FC1", .data = data}));
  }
  const auto source = open(bag.finish());
  const auto tags = source->streams()[0].tags;
  EXPECT_EQ(tags.at("DEPTH_UNIT"), "1000");
  EXPECT_EQ(tags.at("DEPTH_INVALID"), "0");
  const auto frames = framesOf(*source, StreamInfo(source->streams()[0]));
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(sample(frames[0], 0, 0), 0u);
  const double value = frames[2].value_per_code;
  EXPECT_NEAR(value * sample(frames[2], 0, 0), 0.5, 1e-3);
  EXPECT_EQ(sample(frames[2], 1, 0), 0u);
  EXPECT_NEAR(value * sample(frames[2], 0, 1), 2.2504, 1e-3);
  EXPECT_EQ(sample(frames[2], 1, 1), 0u);
}

TEST_F(RosbagSource, RefusesBagsWithoutPicturesAndOtherVersionsInOneLine) {
  BagWriter bag;
  bag.write(bag.connect("/scan", "sensor_msgs/LaserScan"), 0, "nothing");
  const auto scan = openingOf(bag.finish());
  EXPECT_EQ(scan.error().code, ErrorCode::NotFound);
  EXPECT_NE(std::string(scan.error().message).find("has no pictures"), std::string::npos);

  BagWriter odd;
  BagImage image = depthImage(0);
  image.encoding = "64FC9";
  odd.write(odd.connect("/depth", "sensor_msgs/Image"), 0, bagImage(image));
  EXPECT_EQ(openingOf(odd.finish()).error().code, ErrorCode::Unsupported);

  BagWriter packed;
  packed.write(packed.connect("/color", "sensor_msgs/Image"), 0,
               bagImage({.stamp_ns = 5, .cols = 1, .rows = 1, .step = 3, .encoding = "rgb8", .data = "abc"}));
  packed.write(packed.connect("/depth/compressedDepth", "sensor_msgs/CompressedImage"), 0,
               bagCompressedImage(5, "16UC1; compressedDepth rvl", std::string(40, '\1')));
  const auto rvl = openingOf(packed.finish());
  EXPECT_EQ(rvl.error().code, ErrorCode::Unsupported);
  EXPECT_NE(std::string(rvl.error().message).find("republish compressedDepth"), std::string::npos);

  EXPECT_EQ(openingOf("#ROSBAG V1.2\n").error().code, ErrorCode::Unsupported);
  EXPECT_EQ(openingOf(BagWriter().finish()).error().code, ErrorCode::Corrupt) << "empty";
}

// What the process has read from files, in bytes.
std::uint64_t bytesRead() {
  std::ifstream io("/proc/self/io");
  std::string name;
  std::uint64_t count = 0;
  io >> name >> count;
  return count;
}

// 128 chunks of 16 MiB, in each of which a picture comes before a message of another kind.
TEST_F(RosbagSource, ALargeBagIsNeverReadWhole) {
  if (bytesRead() == 0) GTEST_SKIP() << "the kernel does not count what is read";
  constexpr int kChunks = 128;
  for (const bool indexed : {true, false}) {
    BagWriter bag;
    const auto depth = bag.connect("/depth", "sensor_msgs/Image");
    const auto points = bag.connect("/points", "sensor_msgs/PointCloud2");
    for (int i = 0; i < kChunks; ++i) {
      bag.write(depth, kFirstStamp + i * kPeriod, bagImage(depthImage(i)));
      bag.writeHole(points, kFirstStamp, 16 << 20);
    }
    const std::string path = folder_ / "large.bag";
    bag.save(path, indexed);
    ASSERT_GE(std::filesystem::file_size(path), std::uint64_t{2} << 30);
    const std::uint64_t before = bytesRead();
    const auto source = makeRosbagSource();
    ASSERT_TRUE(source->open(path));
    ASSERT_TRUE(source->seek(MediaTime(Duration(100 * kPeriod))));
    const auto packet = source->read();
    ASSERT_TRUE(packet && *packet);
    EXPECT_EQ((*packet)->pts, MediaTime(Duration(100 * kPeriod)));
    EXPECT_LT(bytesRead() - before, std::uint64_t{1} << 20);
  }
}

TEST_F(RosbagSource, IsToldByItsFirstBytes) {
  EXPECT_TRUE(isRosbag(save("#ROSBAG V2.0\n")));
  EXPECT_TRUE(isRosbag("file:" + save("#ROSBAG V1.2\n")));
  EXPECT_FALSE(isRosbag(save("#ROSBA")));
  EXPECT_FALSE(isRosbag(folder_ / "absent.bag"));
  EXPECT_FALSE(isRosbag(folder_ / ""));
}

}  // namespace
}  // namespace relievo::test
