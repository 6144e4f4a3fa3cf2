// SPDX-License-Identifier: Apache-2.0
// Scans in one file, which the test writes by the formats' own pages: sizes, units, times, damage.
#include "drivers/scan/scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "app/media/pair_reader.h"
#include "drivers/registry.h"
#include "tests/support/byte_writer.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/failing_disk.h"
#include "tests/support/film/real_backends.h"

namespace relievo {
namespace {

using test::number;
using test::sampleAt;
using testing::Contains;
using testing::HasSubstr;

constexpr int kCols = 32, kRows = 24, kFrames = 4;

int codeAt(int c, int r, int frame) {
  return c == 0 && r == 0 ? 0 : 1000 + 10 * c + 3 * r + frame;
}
std::string depthSamples(int frame) {
  std::string bytes;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) bytes += number(static_cast<std::uint16_t>(codeAt(c, r, frame)));
  }
  return bytes;
}

// zlib's format (RFC 1950) with one stored block (RFC 1951).
std::string deflated(const std::string& bytes) {
  std::uint32_t a = 1, b = 0;
  for (const unsigned char byte : bytes) a = (a + byte) % 65521, b = (b + a) % 65521;
  const auto length = static_cast<std::uint16_t>(bytes.size());
  std::string sum = number(b << 16 | a);
  std::ranges::reverse(sum);
  return "\x78\x01\x01" + number(length) + number(static_cast<std::uint16_t>(~length)) + bytes + sum;
}

class Scans : public testing::Test {
 protected:
  std::string save(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  // A picture as another program codes it.
  std::string coded(const char* name, const char* codec, const char* format) {
    test::makeClip(folder_ / name, {{.codec = codec, .pix_fmt = format, .width = kCols, .height = kRows, .frames = 1}});
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  struct Sens {
    std::int32_t color_coding = 1, depth_coding = 1;  // PNG, zlib
    float codes_per_metre = 1000;
    std::uint64_t period_us = 33'367;
  };
  std::string sens(const Sens& kind) {
    const std::string name = "StructureSensor", color = coded("a.png", "png", "rgb24");
    std::string bytes = number(std::uint32_t{4}) + number(std::uint64_t{name.size()}) + name + std::string(256, '\1');
    bytes += number(kind.color_coding) + number(kind.depth_coding);
    for (const int size : {kCols, kRows, kCols, kRows}) bytes += number(static_cast<std::uint32_t>(size));
    bytes += number(kind.codes_per_metre) + number(std::uint64_t{kFrames});
    for (int i = 0; i < kFrames; ++i) {
      const std::string depth = kind.depth_coding == 1 ? deflated(depthSamples(i)) : depthSamples(i);
      const std::uint64_t time = 7'000'000 + static_cast<std::uint64_t>(i) * kind.period_us;
      bytes += std::string(64, '\2') + number(time) + number(time + 5000) + number(std::uint64_t{color.size()}) +
               number(std::uint64_t{depth.size()}) + color + depth;
    }
    return bytes + number(std::uint64_t{0});
  }
  std::string klg(bool plain_depth) {
    const std::string color = coded("a.jpg", "mjpeg", "yuvj420p");
    std::string bytes = number(std::int32_t{kFrames});
    for (int i = 0; i < kFrames; ++i) {
      const std::string depth = plain_depth ? depthSamples(i) : deflated(depthSamples(i));
      bytes += number(std::int64_t{5'000'000 + i * 40'000}) + number(static_cast<std::int32_t>(depth.size())) +
               number(static_cast<std::int32_t>(color.size())) + depth + color;
    }
    return bytes;
  }

  // Each picture's time, us; the depth of every sample is checked.
  std::vector<long> timesOf(const std::string& path) {
    PairReader reader(kReal);
    const auto opened = reader.open({.url = path});
    EXPECT_TRUE(opened) << opened.error().message;
    info_ = reader.info();
    std::vector<long> times;
    for (auto pair = reader.next(); opened && pair && *pair; pair = reader.next()) {
      const Frame& depth = (*pair)->depth;
      const int frame = static_cast<int>(times.size());
      times.push_back(std::lround(1e6 * toSeconds((*pair)->color.pts)));
      EXPECT_EQ(depth.width, kCols);
      for (int r = 0; r < depth.height; ++r) {
        for (int c = 0; c < depth.width; ++c) {
          EXPECT_EQ(static_cast<int>(sampleAt(depth, 0, c, r)), codeAt(c, r, frame)) << c << ", " << r;
        }
      }
    }
    return times;
  }
  std::string refusalOf(const std::string& path) {
    const auto opened = drivers::makeMediaSource(path)->open(path);
    return opened ? "opened" : opened.error().message;
  }

  test::TemporaryFolder folder_;
  FilmInfo info_;
};

TEST_F(Scans, SensIsReadToTheCodeInItsOwnUnitAndTimes) {
  EXPECT_THAT(timesOf(save("a.sens", sens({}))), testing::ElementsAre(0, 33'367, 66'734, 100'101));
  EXPECT_EQ(info_.calibration.calibration.unit_mm, 1);
  EXPECT_THAT(timesOf(save("b.sens", sens({.depth_coding = 0, .codes_per_metre = 5000}))), testing::SizeIs(kFrames));
  EXPECT_EQ(info_.calibration.calibration.unit_mm, 0.2);
  EXPECT_TRUE(info_.has_depth);
}

TEST_F(Scans, KlgTakesItsSizeFromTheColour) {
  for (const bool plain : {false, true})
    EXPECT_THAT(timesOf(save("a.klg", klg(plain))), testing::ElementsAre(0, 40'000, 80'000, 120'000));
}

TEST_F(Scans, WithoutTimesThereAre30FramesASecond) {
  EXPECT_THAT(timesOf(save("a.sens", sens({.period_us = 0}))), testing::ElementsAre(0, 33'333, 66'667, 100'000));
}

TEST_F(Scans, OneThatWasCutOffEndsWithItsLastWholeFrame) {
  const std::string whole = sens({});
  EXPECT_THAT(timesOf(save("a.sens", whole.substr(0, whole.size() - 100))), testing::SizeIs(kFrames - 1));
  EXPECT_THAT(info_.notes, Contains(HasSubstr("cut off")));
}

TEST_F(Scans, AreLostWhenTheDiskFails) {
  for (const std::string& path : {save("a.sens", sens({})), save("a.klg", klg(false))}) {
    const auto source = drivers::makeMediaSource(path);
    ASSERT_TRUE(source->open(path));
    EXPECT_EQ(test::endOnFailingDisk(*source), ErrorCode::Lost) << path;
    EXPECT_EQ(source->missedPictures(), 0u);
  }
}

TEST_F(Scans, WhatIsNoneIsToldInOneLine) {
  EXPECT_THAT(refusalOf(save("a.sens", "a scan of nothing")), HasSubstr("is no scan"));
  EXPECT_THAT(refusalOf(save("a.klg", std::string(64, '\x7f'))), HasSubstr("no whole frame"));
  EXPECT_THAT(refusalOf(save("b.sens", sens({.depth_coding = 2}))), HasSubstr("SensReader"));
  EXPECT_THAT(refusalOf(save("c.sens", sens({.codes_per_metre = 0}))), HasSubstr("is no scan"));
}

}  // namespace
}  // namespace relievo
