// SPDX-License-Identifier: Apache-2.0
// Bags that the test writes itself: RealSense's layout and ROS's own, every packing, cut off, without an index.
#include "drivers/rosbag/rosbag.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>

#include "app/media/registration/registration.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/recording/bag_writer.h"
#include "tests/support/film/recording/recorded_frames.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::BagImage;
using test::BagWriter;
using test::framesOf;

constexpr std::uint32_t kCols = 24, kRows = 16;
constexpr int kPictures = 12;
constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kFirstStamp = 1'600'000'000'123'456'789;
constexpr std::int64_t kPeriod = 33'366'700;  // no whole number of ms

// Falls to the right and downwards; a hole at the top left, another code of a hole beside it.
std::uint16_t codeAtSample(std::uint32_t c, std::uint32_t r, int picture) {
  if (c == 0 && r == 0) return 0;
  if (c == 1 && r == 0) return 65535;
  return static_cast<std::uint16_t>(1000 + 20 * r + c + 3 * static_cast<std::uint32_t>(picture));
}

struct Layout {
  bool big_endian = false;
  std::uint32_t padding = 0;  // behind each row
};
std::string depthData(int picture, const Layout& layout = {}) {
  std::string data;
  for (std::uint32_t r = 0; r < kRows; ++r) {
    for (std::uint32_t c = 0; c < kCols; ++c) {
      const std::uint16_t code = codeAtSample(c, r, picture);
      const std::uint16_t stored = layout.big_endian ? std::byteswap(code) : code;
      data.append(reinterpret_cast<const char*>(&stored), sizeof stored);
    }
    data.append(layout.padding, '\x55');
  }
  return data;
}
BagImage depthImage(int picture, const Layout& layout = {}) {
  return {.stamp_ns = kFirstStamp + picture * kPeriod,
          .cols = kCols,
          .rows = kRows,
          .step = 2 * kCols + layout.padding,
          .encoding = "16UC1",
          .big_endian = layout.big_endian,
          .data = depthData(picture, layout)};
}
// Red at the top left, blue elsewhere.
BagImage colorImage(int picture, const std::string& encoding = "rgb8") {
  std::string data;
  for (std::uint32_t i = 0; i < kCols * kRows; ++i) {
    const bool red = i < 4;
    data += encoding == "rgb8" ? (red ? "\xff" : std::string(1, '\0')) : (red ? std::string(1, '\0') : "\xff");
    data += std::string(1, '\0');
    data += encoding == "rgb8" ? (red ? std::string(1, '\0') : "\xff") : (red ? "\xff" : std::string(1, '\0'));
  }
  return {.stamp_ns = kFirstStamp + picture * kPeriod + 5 * kMs,
          .cols = kCols,
          .rows = kRows,
          .step = 3 * kCols,
          .encoding = encoding,
          .data = data};
}

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
    bag.write(depth, recorded, test::bagImage(depthImage(i)));
    bag.write(imu, recorded, "nothing");
    bag.write(color, recorded + 5 * kMs, test::bagImage(colorImage(i)));
    if (i % 3 == 2) bag.endChunk();
  }
  return bag.finish(indexed);
}

class RosbagSource : public testing::Test {
 protected:
  std::string save(const std::string& bytes) {
    const std::string path = folder_ / ("film" + std::to_string(saved_++) + ".bag");
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::unique_ptr<MediaSource> open(const std::string& bytes) {
    auto source = makeRosbagSource();
    const auto opened = source->open(save(bytes));
    EXPECT_TRUE(opened) << opened.error().message;
    return source;
  }
  Result<void> openingOf(const std::string& bytes) { return makeRosbagSource()->open(save(bytes)); }
  test::TemporaryFolder folder_;
  int saved_ = 0;
};

const StreamInfo* streamOf(const MediaSource& source, const std::string& title) {
  for (const StreamInfo& stream : source.streams()) {
    if (stream.tags.at("TITLE") == title) return &stream;
  }
  return nullptr;
}

std::uint32_t sample(const Frame& frame, std::uint32_t c, std::uint32_t r, int component = 0) {
  return test::sampleAt(frame, component, static_cast<int>(c), static_cast<int>(r));
}

void expectDepth(const std::vector<Frame>& frames, int first = 0, int count = kPictures) {
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.pts, MediaTime(Duration((first + i) * kPeriod))) << "exact";
    ASSERT_EQ(frame.width, static_cast<int>(kCols));
    ASSERT_EQ(frame.height, static_cast<int>(kRows));
    for (std::uint32_t r = 0; r < kRows; ++r) {
      for (std::uint32_t c = 0; c < kCols; ++c) ASSERT_EQ(sample(frame, c, r), codeAtSample(c, r, first + i));
    }
  }
}

struct Variant {
  const char* name;
  const char* compression;
  bool indexed;
};
class RosbagVariants : public RosbagSource, public testing::WithParamInterface<Variant> {};
INSTANTIATE_TEST_SUITE_P(Packings, RosbagVariants,
                         testing::Values(Variant{"plain", "none", true}, Variant{"lz4", "lz4", true},
                                         Variant{"bz2", "bz2", true}, Variant{"plain_without_index", "none", false},
                                         Variant{"lz4_without_index", "lz4", false},
                                         Variant{"bz2_without_index", "bz2", false}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(RosbagVariants, HoldsDepthAndColourToTheSample) {
  const std::string bag = rosBag(GetParam().compression, GetParam().indexed);
  const auto source = open(bag);
  ASSERT_EQ(source->streams().size(), 2u);
  const StreamInfo* const depth = streamOf(*source, "/camera/depth/image_raw");
  ASSERT_NE(depth, nullptr);
  EXPECT_EQ(depth->kind, StreamKind::Video);
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
  const auto source = open(rosBag(GetParam().compression, GetParam().indexed));
  const StreamInfo depth = *streamOf(*source, "/camera/depth/image_raw");
  for (const int picture : {7, 0, 11, 3, 2}) {
    ASSERT_TRUE(source->seek(MediaTime(Duration(picture * kPeriod + 6 * kMs))));
    expectDepth(framesOf(*source, depth), picture, kPictures - picture);
  }
  ASSERT_TRUE(source->seek(MediaTime(-1s)));
  expectDepth(framesOf(*source, depth));
}

// Cut at every 149th byte: what is whole before the cut is played, and the end is an end.
TEST_P(RosbagVariants, CutOffAnywhereItPlaysWhatIsWhole) {
  const std::string bag = rosBag(GetParam().compression, GetParam().indexed);
  std::size_t before = 0;
  for (std::size_t length = 0; length < bag.size(); length += 149) {
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

TEST_F(RosbagSource, TakesBigEndianAndPaddedRows) {
  for (const Layout layout : {Layout{.big_endian = true}, Layout{.padding = 10}}) {
    BagWriter bag;
    const auto depth = bag.connect("/depth", "sensor_msgs/Image");
    for (int i = 0; i < kPictures; ++i) bag.write(depth, kFirstStamp, test::bagImage(depthImage(i, layout)));
    const auto source = open(bag.finish());
    expectDepth(framesOf(*source, source->streams()[0]));
  }
}

TEST_F(RosbagSource, FloatsAreMetres) {
  BagWriter bag;
  const auto depth = bag.connect("/depth", "sensor_msgs/Image");
  std::string data;
  for (const float metres : {0.5F, std::nanf(""), 2.2504F, 0.0F}) {
    data.append(reinterpret_cast<const char*>(&metres), sizeof metres);
  }
  bag.write(depth, kFirstStamp,
            test::bagImage({.stamp_ns = 5, .cols = 2, .rows = 2, .step = 8, .encoding = "32FC1", .data = data}));
  const auto source = open(bag.finish());
  const auto tags = source->streams()[0].tags;
  EXPECT_EQ(tags.at("DEPTH_UNIT"), "1000");
  EXPECT_EQ(tags.at("DEPTH_INVALID"), "0");
  const auto frames = framesOf(*source, StreamInfo(source->streams()[0]));
  ASSERT_EQ(frames.size(), 1u);
  const double value = frames[0].value_per_code;
  EXPECT_NEAR(value * sample(frames[0], 0, 0), 0.5, 1e-3);
  EXPECT_EQ(sample(frames[0], 1, 0), 0u);
  EXPECT_NEAR(value * sample(frames[0], 0, 1), 2.2504, 1e-3);
  EXPECT_EQ(sample(frames[0], 1, 1), 0u);
}

// RealSense's layout: mono16 is depth, 16UC1 and 8UC1 are infrared, and stamps may come from two clocks.
std::string realSenseBag(std::int64_t color_clock_ns, float unit_m) {
  BagWriter bag("lz4");
  const std::string device = "/device_0/sensor_0/";
  const auto unit = bag.connect(device + "option/Depth_Units/value", "std_msgs/Float32");
  const auto infrared = bag.connect(device + "Infrared_1/image/data", "sensor_msgs/Image");
  const auto depth = bag.connect(device + "Depth_0/image/data", "sensor_msgs/Image");
  const auto color = bag.connect("/device_0/sensor_1/Color_0/image/data", "sensor_msgs/Image");
  bag.write(unit, 0, test::ByteWriter().add(0.0001F).bytes());
  for (int i = 0; i < kPictures; ++i) {
    BagImage z = depthImage(i), light = depthImage(i), picture = colorImage(i, "bgr8");
    z.encoding = "mono16";
    z.unit_m = unit_m;
    light.encoding = "16UC1";
    picture.stamp_ns += color_clock_ns;
    const std::int64_t recorded = 1000 * kMs + i * 33 * kMs;  // since the device was started
    bag.write(infrared, recorded, test::bagImage(light));
    bag.write(depth, recorded, test::bagImage(z));
    bag.write(color, recorded + 4 * kMs, test::bagImage(picture));
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

const test::BagCamera kDepthCamera{
    .cols = kCols, .rows = kRows, .focal_x = 30, .focal_y = 31, .center_x = 11, .center_y = 8};
test::BagCamera colorCamera(const std::string& model) {
  return {.cols = 2 * kCols,
          .rows = 2 * kRows,
          .focal_x = 60,
          .focal_y = 61,
          .center_x = 23,
          .center_y = 16,
          .model = model,
          .distortion = {0.1, -0.2, 0.001, 0.002, 0.03}};
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
    bag.write(bag.connect(depth + "/image/data", "sensor_msgs/Image"), 1, test::bagImage(z));
    bag.write(bag.connect(color + "/image/data", "sensor_msgs/Image"), 1, test::bagImage(colorImage(0)));
    bag.write(bag.connect(depth + "/info/camera_info", "sensor_msgs/CameraInfo"), 1, test::bagCameraInfo(kDepthCamera));
    bag.write(bag.connect(color + "/info/camera_info", "sensor_msgs/CameraInfo"), 1,
              test::bagCameraInfo(colorCamera("Inverse Brown Conrady")));
    bag.write(bag.connect(depth + "/tf/0", "geometry_msgs/Transform"), 1, test::bagTransform({0.01, 0, 0}, kUpright));
    bag.write(bag.connect(color + "/tf/" + reference, "geometry_msgs/Transform"), 1,
              test::bagTransform({0.05, 0.02, 0}, kQuarterTurn));
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
  const auto tagsOf = [&](const std::string& lens, const std::string& color_frame) {
    BagWriter bag;
    BagImage z = depthImage(0), picture = colorImage(0);
    z.frame = "depth_optical";
    picture.frame = color_frame;
    bag.write(bag.connect("/cam/depth/image_raw", "sensor_msgs/Image"), 1, test::bagImage(z));
    bag.write(bag.connect("/cam/rgb/image_raw", "sensor_msgs/Image"), 1, test::bagImage(picture));
    bag.write(bag.connect("/cam/depth/camera_info", "sensor_msgs/CameraInfo"), 1, test::bagCameraInfo(kDepthCamera));
    bag.write(bag.connect("/cam/rgb/camera_info", "sensor_msgs/CameraInfo"), 1, test::bagCameraInfo(colorCamera(lens)));
    const auto frames = bag.connect("/tf_static", "tf2_msgs/TFMessage");
    bag.write(frames, 1, test::bagFrameMotion("base", "depth_optical", test::bagTransform({0.1, 0, 0}, kUpright)));
    bag.write(frames, 1,
              test::bagFrameMotion("base", "/color_optical", test::bagTransform({0.1, 0.03, 0}, kQuarterTurn)));
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
    for (const auto color : {left_color, right_color}) bag.write(color, kFirstStamp, test::bagImage(colorImage(i)));
    if (i > 2) bag.write(left_depth, kFirstStamp, test::bagImage(depthImage(i)));
    bag.write(right_depth, kFirstStamp, test::bagImage(depthImage(i)));
  }
  const auto source = open(bag.finish());
  for (const StreamInfo& stream : source->streams()) {
    const bool right = stream.tags.at("TITLE").starts_with("/right");
    EXPECT_EQ(stream.kind, right ? StreamKind::Video : StreamKind::Other) << stream.tags.at("TITLE");
  }
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
  odd.write(odd.connect("/depth", "sensor_msgs/Image"), 0, test::bagImage(image));
  EXPECT_EQ(openingOf(odd.finish()).error().code, ErrorCode::Unsupported);

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

// 128 chunks of 16 MiB, in which a picture stands before a message of another kind.
TEST_F(RosbagSource, ALargeBagIsNeverReadWhole) {
  if (bytesRead() == 0) GTEST_SKIP() << "the kernel does not count what is read";
  constexpr int kChunks = 128;
  for (const bool indexed : {true, false}) {
    BagWriter bag;
    const auto depth = bag.connect("/depth", "sensor_msgs/Image");
    const auto points = bag.connect("/points", "sensor_msgs/PointCloud2");
    for (int i = 0; i < kChunks; ++i) {
      bag.write(depth, kFirstStamp + i * kPeriod, test::bagImage(depthImage(i)));
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
}  // namespace relievo
