// SPDX-License-Identifier: Apache-2.0
// Films without calibration: depth in half of a picture, hues over YUV, gray in RGB.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "app/media/pair_reader.h"
#include "app/scene/height_field.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ffmpeg_backends.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::hueColor;
using test::makeClip;
using test::TemporaryFolder;

constexpr DisplayVolume kVolume{160, 108, 40};

std::uint32_t yuv(int k, double red, double green, double blue) {
  return test::yuvCode(k, {red, green, blue});
}
std::array<double, 3> photo(int c, int r) {
  return {0.5 + 0.4 * std::sin(0.3 * c), 0.3 + 0.002 * r, 0.4 + 0.3 * std::cos(0.2 * r)};
}
double slopeHue(int c, int width) {
  return 0.1 + 0.7 * c / width;
}

// Colour and depth side by side or one above the other in one yuv444p picture with halves of 64 x 48.
ClipTrack packed(bool beside, bool depth_first, bool hue) {
  ClipTrack track{.pix_fmt = "yuv444p", .width = beside ? 128 : 64, .height = beside ? 48 : 96, .frames = 3};
  track.sample = [=](int k, int c, int r, int) {
    const bool second = beside ? c >= 64 : r >= 48;
    const int x = c % 64, y = r % 48;
    if (second == depth_first) {
      const auto color = photo(x, y);
      return yuv(k, color[0], color[1], color[2]);
    }
    const auto color = hueColor(slopeHue(x, 64));
    const double gray = 0.2 + 0.6 * x / 64;
    return hue ? yuv(k, color[0], color[1], color[2]) : yuv(k, gray, gray, gray);
  };
  return track;
}

TEST(DepthReading, HalvesThatDifferClearlyAreFoundWhicheverOneIsTheDepth) {
  TemporaryFolder folder;
  const struct {
    bool beside, depth_first;
    Packing packing;
  } ways[] = {{true, false, Packing::SideBySide},
              {true, true, Packing::SideBySideDepthFirst},
              {false, false, Packing::TopBottom},
              {false, true, Packing::TopBottomDepthFirst}};
  for (const auto& way : ways) {
    for (const bool hue : {false, true}) {
      makeClip(folder / "packed.mkv", {packed(way.beside, way.depth_first, hue)});
      PairReader reader(kFfmpeg);
      ASSERT_TRUE(reader.open({.url = folder / "packed.mkv"})) << reader.failedThing();
      const FilmInfo& info = reader.info();
      EXPECT_EQ(info.packing, way.packing);
      EXPECT_EQ(info.calibration.calibration.code, hue ? DepthCode::Hue : DepthCode::Luma);
      EXPECT_FALSE(info.reading.why.empty());
      const auto pair = reader.next();
      ASSERT_TRUE(pair && *pair);
      const HeightField field = HeightField::make((*pair)->depth, info.calibration.calibration, kVolume).value();
      // For a hue s is 1 - hue, since near is low; for gray it is the brightness.
      for (const int c : {5, 30, 60}) {
        const double s = hue ? 1 - slopeHue(c, 64) : 0.2 + 0.6 * c / 64;
        EXPECT_NEAR(field.heightMm(c, 20), kVolume.depth_mm * s, hue ? 0.25 : 0.1) << c;
      }
    }
  }
}

TEST(DepthReading, APhotoBesideAPhotoIsNoDepth) {
  TemporaryFolder folder;
  ClipTrack stereo{.pix_fmt = "yuv444p", .width = 128, .height = 48, .frames = 3};
  stereo.sample = [](int k, int c, int r, int) {
    const auto color = photo(c % 64 + c / 64, r);
    return yuv(k, color[0], color[1], color[2]);
  };
  makeClip(folder / "stereo.mkv", {stereo});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "stereo.mkv"}));
  EXPECT_FALSE(reader.info().has_depth);
}

// 4:2:0, 8 and 10 bits, with a hue step inside a chroma sample: the mean of two hues is neither of them.
TEST(DepthReading, HueOverYuvIsReadAndItsMixedEdgesAreOneSideOrTheOther) {
  TemporaryFolder folder;
  for (const bool ten : {false, true}) {
    ClipTrack film{.pix_fmt = ten ? "yuv420p10le" : "yuv420p", .width = 64, .height = 48, .frames = 2};
    film.sample = [ten](int k, int c, int r, int) {
      const int column = k == 0 ? c : 2 * c;
      const auto at = [&](int x) { return hueColor(x < 33 ? 0.15 : 0.65); };  // 33: within a chroma sample
      auto color = at(column);
      if (k > 0) {
        const auto other = at(column + 1);
        for (std::size_t i = 0; i < 3; ++i) color[i] = 0.5 * (color[i] + other[i]);
      }
      (void)r;
      return yuv(k, color[0], color[1], color[2]) << (ten ? 2 : 0);
    };
    makeClip(folder / "color.mkv", {{.pix_fmt = "yuv420p", .frames = 2}});
    makeClip(folder / "hue.mkv", {film});
    PairReader reader(kFfmpeg);
    ASSERT_TRUE(reader.open({.url = folder / "color.mkv", .depth_url = folder / "hue.mkv"}));
    EXPECT_EQ(reader.info().calibration.calibration.code, DepthCode::Hue);
    const auto pair = reader.next();
    ASSERT_TRUE(pair && *pair);
    const HeightField field = HeightField::make((*pair)->depth, reader.info().calibration.calibration, kVolume).value();
    for (int c = 0; c < 64; ++c) {
      const double height = field.heightMm(c, 20);
      if (c / 2 == 16) {
        EXPECT_TRUE(std::abs(height - 34) < 1 || std::abs(height - 14) < 1) << c << ": " << height;
      } else {
        EXPECT_NEAR(height, c < 33 ? 34 : 14, 0.3) << c;  // 40 (1 - hue)
      }
    }
  }
}

TEST(DepthReading, GrayInRgbIsReadByItsBrightness) {
  TemporaryFolder folder;
  ClipTrack gray{.codec = "png", .pix_fmt = "rgb24", .width = 256, .height = 8, .frames = 1};
  gray.sample = [](int, int c, int, int) { return static_cast<std::uint32_t>(c); };
  makeClip(folder / "color.mkv", {{.pix_fmt = "yuv420p", .width = 256, .height = 8, .frames = 1}});
  makeClip(folder / "gray.mkv", {gray});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "color.mkv", .depth_url = folder / "gray.mkv"}));
  const auto pair = reader.next();
  ASSERT_TRUE(pair && *pair);
  const HeightField field = HeightField::make((*pair)->depth, reader.info().calibration.calibration, kVolume).value();
  EXPECT_NEAR(field.heightMm(51, 3), 8, 1e-9);
  EXPECT_THAT(reader.info().reading.doubts, testing::ElementsAre(testing::HasSubstr("nothing says which end")));
}

}  // namespace
}  // namespace relievo
