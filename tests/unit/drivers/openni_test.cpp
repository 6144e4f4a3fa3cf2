// SPDX-License-Identifier: Apache-2.0
// OpenNI recordings that the test writes itself: every packing, with and without tables, old, cut off, damaged.
#include "drivers/openni/openni.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>

#include "drivers/openni/depth_codec.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/failing_disk.h"
#include "tests/support/film/recording/oni_writer.h"
#include "tests/support/film/recording/recorded_frames.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::framesOf;
using test::OniNode;
using test::OniWriter;

constexpr std::uint32_t kCols = 24, kRows = 16;
constexpr int kPictures = 12;
constexpr std::int64_t kFirstUs = 7'123'456, kPeriodUs = 33'367;  // no whole number of ms

// ---- packed depth, by hand

using Bytes = std::vector<std::uint8_t>;
using Samples = std::vector<std::uint16_t>;

TEST(OpenniDepth, StepsAreHalfBytesAndRepeatsAByte) {
  // 10000; up 1, down 1; two pairs of no step; down 9; no step, then 0x1234 as it is; down 1, and padding
  const Bytes packed{0x10, 0x27, 0x57, 0xe2, 0xff, 201, 0x6f, 0x12, 0x34, 0x7d};
  const Samples expected{10000, 10001, 10000, 10000, 10000, 10000, 10000, 9991, 9991, 4660, 4659};
  Samples samples(expected.size());
  ASSERT_TRUE(openni::unpack16z(packed, samples));
  EXPECT_EQ(samples, expected);
  for (const std::size_t other : {expected.size() - 1, expected.size() + 1}) {
    Samples wrong(other);
    EXPECT_FALSE(openni::unpack16z(packed, wrong)) << "a picture of another size";
  }
}

TEST(OpenniDepth, ATableHoldsTheValues) {
  // three values; the second; down 1, up 1; up 1, and padding
  const Bytes packed{3, 0, 0, 0, 0xe8, 0x03, 0xff, 0xff, 1, 0, 0x75, 0x5d};
  Samples samples(4);
  ASSERT_TRUE(openni::unpack16zTable(packed, samples));
  EXPECT_EQ(samples, (Samples{1000, 0, 1000, 65535}));
}

TEST(OpenniDepth, DamageIsRefused) {
  Samples samples(4);
  EXPECT_FALSE(openni::unpack16zTable(Bytes{3, 0, 0, 0, 0xe8, 0x03, 0xff, 0xff, 1, 0, 0x75, 0x4d}, samples))
      << "a place behind the table's end";
  EXPECT_FALSE(openni::unpack16zTable(Bytes{200, 0, 0, 0}, samples)) << "a table longer than the picture";
  EXPECT_FALSE(openni::unpack16zTable(Bytes{0, 0, 1, 0, 0x66, 0x6d}, samples)) << "no table";
  EXPECT_FALSE(openni::unpack16z(Bytes{0x10}, samples));
  EXPECT_FALSE(openni::unpack16z(Bytes{0x10, 0x27, 0x66, 0xff}, samples)) << "a step that is missing";
  EXPECT_FALSE(openni::unpack16z(Bytes{0x10, 0x27, 0x66, 0xff, 0x12}, samples)) << "half a value";
  EXPECT_FALSE(openni::unpack16z(Bytes{0x10, 0x27, 0x66, 0xd6}, samples)) << "a step that is none";
}

// ---- recordings

// Falls to the right and downwards; a hole at the top left, and steps of all sizes.
std::uint16_t codeAtSample(std::uint32_t c, std::uint32_t r, int picture) {
  if (c == 0 && r == 0) return 0;
  if (r == 3) return static_cast<std::uint16_t>(700 + 40 * c);
  return static_cast<std::uint16_t>(1000 + 20 * r + c / 3 + 3 * static_cast<std::uint32_t>(picture));
}
Samples depthSamples(int picture) {
  Samples samples;
  for (std::uint32_t r = 0; r < kRows; ++r) {
    for (std::uint32_t c = 0; c < kCols; ++c) samples.push_back(codeAtSample(c, r, picture));
  }
  return samples;
}
std::string packed(const std::string& codec, int picture) {
  const Samples samples = depthSamples(picture);
  if (codec == "16zT") return test::oni16zTable(samples);
  if (codec == "16zP") return test::oni16z(samples);
  return {reinterpret_cast<const char*>(samples.data()), 2 * samples.size()};
}
std::string colorData(int picture) {
  std::string data;
  for (std::uint32_t i = 0; i < kCols * kRows; ++i) {
    for (const int value : {200 + picture, 10, static_cast<int>(i % 100)}) data += static_cast<char>(value);
  }
  return data;
}

struct Variant {
  const char* name;
  const char* codec;
  bool wide, tables;
};
// Depth 5 ms after each colour, and infrared.
std::string recording(const Variant& variant) {
  OniWriter oni(variant.wide);
  const std::uint64_t format = variant.wide ? test::kOniMm : 0;
  const auto color = oni.add({.kind = test::kOniColor,
                              .codec = "NONE",
                              .cols = kCols,
                              .rows = kRows,
                              .format = variant.wide ? test::kOniRgb : 0,
                              .old_format = 1});
  const auto depth = oni.add({.codec = variant.codec, .cols = kCols, .rows = kRows, .format = format, .old_format = 4});
  const auto infrared =
      oni.add({.kind = test::kOniInfrared, .codec = "NONE", .cols = kCols, .rows = kRows, .format = 203});
  for (int i = 0; i < kPictures; ++i) {
    const std::uint64_t time = kFirstUs + i * kPeriodUs;
    oni.write(color, time, colorData(i));
    oni.write(depth, time + 5000, packed(variant.codec, i));
    oni.write(infrared, time, std::string(kCols * kRows * 2, '\7'));
  }
  return oni.finish(variant.tables);
}
constexpr Variant kUsual{"", "16zT", true, true};

class OpenniSource : public testing::Test {
 protected:
  std::string save(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    return path_;
  }
  std::unique_ptr<MediaSource> open(const std::string& bytes) {
    auto source = makeOpenniSource();
    const auto opened = source->open(save(bytes));
    EXPECT_TRUE(opened) << opened.error().message;
    return source;
  }
  Result<void> openingOf(const std::string& bytes) { return makeOpenniSource()->open(save(bytes)); }
  test::TemporaryFolder folder_;
  std::string path_ = folder_ / "film.oni";
};

StreamInfo streamOf(const MediaSource& source, const std::string& title) {
  for (const StreamInfo& stream : source.streams()) {
    if (stream.tags.at("TITLE") == title) return stream;
  }
  return {};
}

std::uint32_t sample(const Frame& frame, std::uint32_t c, std::uint32_t r, int component = 0) {
  return test::sampleAt(frame, component, static_cast<int>(c), static_cast<int>(r));
}

void expectDepth(const std::vector<Frame>& frames, int first = 0, int count = kPictures) {
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.pts, MediaTime(std::chrono::microseconds((first + i) * kPeriodUs + 5000))) << "exact";
    ASSERT_EQ(frame.width, static_cast<int>(kCols));
    ASSERT_EQ(frame.height, static_cast<int>(kRows));
    for (std::uint32_t r = 0; r < kRows; ++r) {
      for (std::uint32_t c = 0; c < kCols; ++c) ASSERT_EQ(sample(frame, c, r), codeAtSample(c, r, first + i));
    }
  }
}

class OpenniVariants : public OpenniSource, public testing::WithParamInterface<Variant> {};
INSTANTIATE_TEST_SUITE_P(Packings, OpenniVariants,
                         testing::Values(Variant{"table", "16zT", true, true}, Variant{"steps", "16zP", true, true},
                                         Variant{"plain", "NONE", true, true},
                                         Variant{"table_cut_off", "16zT", true, false},
                                         Variant{"old", "16zT", false, true},
                                         Variant{"old_cut_off", "16zP", false, false}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(OpenniVariants, HoldsDepthAndColourToTheSample) {
  const std::string bytes = recording(GetParam());
  const auto source = open(bytes);
  ASSERT_TRUE(isOpenni(path_));
  ASSERT_EQ(source->streams().size(), 3u);
  const StreamInfo depth = streamOf(*source, "depth"), color = streamOf(*source, "color");
  EXPECT_EQ(depth.kind, StreamKind::Video);
  EXPECT_EQ(depth.bits, 16);
  EXPECT_EQ(streamOf(*source, "infrared").kind, StreamKind::Other);
  EXPECT_EQ(depth.tags.at("DEPTH_UNIT"), "1");
  EXPECT_EQ(depth.tags.at("DEPTH_INVALID"), "0");
  EXPECT_FALSE(color.tags.contains("DEPTH_UNIT"));
  EXPECT_EQ(depth.frame_period, std::chrono::microseconds(kPeriodUs));
  EXPECT_EQ(source->duration(), std::chrono::microseconds(kPictures * kPeriodUs + 5000));
  expectDepth(framesOf(*source, depth));

  const auto colors = framesOf(*open(bytes), color);
  ASSERT_EQ(colors.size(), static_cast<std::size_t>(kPictures));
  EXPECT_EQ(colors[3].pts, MediaTime(std::chrono::microseconds(3 * kPeriodUs)));
  EXPECT_EQ(sample(colors[3], 7, 1, 0), 203u);
  EXPECT_EQ(sample(colors[3], 7, 1, 1), 10u);
  EXPECT_EQ(sample(colors[3], 7, 1, 2), kCols + 7);
}

TEST_P(OpenniVariants, SeeksToThePictureAtOrBeforeTheTarget) {
  const auto source = open(recording(GetParam()));
  const StreamInfo depth = streamOf(*source, "depth");
  for (const int picture : {7, 0, 11, 3, 2}) {
    ASSERT_TRUE(source->seek(MediaTime(std::chrono::microseconds(picture * kPeriodUs + 6000))));
    expectDepth(framesOf(*source, depth), picture, kPictures - picture);
  }
  ASSERT_TRUE(source->seek(MediaTime(-1s)));
  expectDepth(framesOf(*source, depth));
}

// Cut at every 499th byte: the whole pictures before the cut are played, and then the film ends without an error.
TEST_P(OpenniVariants, CutOffAnywhereItPlaysWhatIsWhole) {
  const std::string bytes = recording(GetParam());
  std::size_t before = 0;
  for (std::size_t length = 0; length < bytes.size(); length += 499) {
    SCOPED_TRACE(length);
    const auto source = makeOpenniSource();
    if (!source->open(save(bytes.substr(0, length)))) {
      EXPECT_EQ(before, 0u);
      continue;
    }
    std::size_t pictures = 0;
    for (;; ++pictures) {
      const auto packet = source->read();
      ASSERT_TRUE(packet);
      if (!*packet) break;
    }
    EXPECT_GE(pictures, before);
    before = pictures;
  }
  EXPECT_EQ(before, static_cast<std::size_t>(2 * kPictures));
}

TEST_F(OpenniSource, ADamagedPictureIsLeftOut) {
  OniWriter oni;
  const auto depth = oni.add({.cols = kCols, .rows = kRows});
  for (int i = 0; i < 3; ++i) {
    std::string picture = packed("16zT", i);
    if (i == 1) picture.pop_back();
    oni.write(depth, static_cast<std::uint64_t>(i) * 1000, picture);
  }
  const auto source = open(oni.finish());
  const auto frames = framesOf(*source, streamOf(*source, "depth"));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].pts, MediaTime(2ms));
  EXPECT_EQ(sample(frames[1], 5, 5), codeAtSample(5, 5, 2));
}

TEST_F(OpenniSource, IsLostWhenTheDiskFails) {
  OniWriter oni;
  const auto depth = oni.add({.cols = kCols, .rows = kRows});
  for (int i = 0; i < 3; ++i) oni.write(depth, static_cast<std::uint64_t>(i) * 1000, packed("16zT", i));
  EXPECT_EQ(test::endOnFailingDisk(*open(oni.finish())), ErrorCode::Lost);
}

// A table that points elsewhere is not believed: the recording is scanned.
TEST_F(OpenniSource, ADamagedTableIsNotUsed) {
  OniWriter oni;
  const auto depth = oni.add({.cols = kCols, .rows = kRows});
  for (int i = 0; i < kPictures; ++i) {
    oni.write(depth, static_cast<std::uint64_t>(i * kPeriodUs + 5000), packed("16zT", i));
  }
  std::string bytes = oni.finish();
  const std::string place = test::ByteWriter().add(oni.place(depth, kPictures - 1)).bytes();
  const std::size_t entry = bytes.rfind(place);
  ASSERT_GT(entry, oni.place(depth, kPictures - 1));
  bytes[entry] = static_cast<char>(bytes[entry] + 1);
  const auto source = open(bytes);
  const auto frames = framesOf(*source, streamOf(*source, "depth"));
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kPictures));
  EXPECT_EQ(sample(frames.back(), 5, 5), codeAtSample(5, 5, kPictures - 1));
}

TEST_F(OpenniSource, JpegIsColour) {
  test::makeClip(folder_ / "a.jpg", {{.codec = "mjpeg",
                                      .pix_fmt = "yuvj420p",
                                      .width = kCols,
                                      .height = kRows,
                                      .frames = 1,
                                      .sample = [](int k, int, int, int) { return k == 0 ? 90U : 128U; }}});
  std::ifstream file(folder_ / "a.jpg", std::ios::binary);
  const std::string jpeg{std::istreambuf_iterator<char>(file), {}};
  OniWriter oni;
  const auto depth = oni.add({.cols = kCols, .rows = kRows, .format = test::kOniTenthsOfMm});
  const auto color =
      oni.add({.kind = test::kOniColor, .codec = "JPEG", .cols = kCols, .rows = kRows, .format = test::kOniRgb});
  oni.write(depth, 0, packed("16zT", 0));
  oni.write(color, 0, jpeg);
  const auto source = open(oni.finish());
  EXPECT_EQ(streamOf(*source, "depth").tags.at("DEPTH_UNIT"), "0.1");
  const auto frames = framesOf(*source, streamOf(*source, "color"));
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(sample(frames[0], 4, 4), 90, 2);
}

TEST_F(OpenniSource, RefusesWhatItCannotReadInOneLine) {
  const auto lineFor = [&](const OniNode& node, bool pictures = true) {
    OniWriter oni;
    const auto id = oni.add(node);
    for (int i = 0; i < 2 && pictures; ++i) oni.write(id, 0, packed("16zT", 0));
    const auto opened = openingOf(oni.finish());
    return opened ? std::string() : std::string(opened.error().message);
  };
  EXPECT_EQ(lineFor({.cols = kCols, .rows = kRows}), "");
  EXPECT_NE(lineFor({.cols = kCols, .rows = kRows}, false).find("no pictures"), std::string::npos);
  EXPECT_NE(lineFor({.cols = kCols, .rows = kRows, .format = test::kOniShifts}).find("raw shifts"), std::string::npos);
  EXPECT_NE(lineFor({.cols = kCols, .rows = kRows, .cropped = true}).find("cropped"), std::string::npos);
  EXPECT_NE(lineFor({.codec = "Im8z", .cols = kCols, .rows = kRows}).find("packed"), std::string::npos);
  EXPECT_NE(lineFor({.cols = 60000, .rows = 60000}).find("packed"), std::string::npos) << "no such memory";
  std::string later = recording(kUsual);
  later[5] = 1;
  const auto opened = openingOf(later);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
  EXPECT_EQ(openingOf("NI10").error().code, ErrorCode::Corrupt);
}

TEST_F(OpenniSource, UnknownColourIsSaidAndDepthPlaysAlone) {
  OniWriter oni;
  const auto color = oni.add({.kind = test::kOniColor, .codec = "Im8z", .cols = kCols, .rows = kRows});
  const auto depth = oni.add({.cols = kCols, .rows = kRows});
  oni.write(color, 0, "picture");
  oni.write(depth, 0, packed("16zT", 0));
  const auto source = open(oni.finish());
  EXPECT_EQ(streamOf(*source, "color").kind, StreamKind::Other);
  ASSERT_EQ(source->notes().size(), 1u);
  EXPECT_NE(source->notes()[0].find("colour"), std::string::npos);
  EXPECT_EQ(framesOf(*source, streamOf(*source, "depth")).size(), 1u);
}

}  // namespace
}  // namespace relievo
