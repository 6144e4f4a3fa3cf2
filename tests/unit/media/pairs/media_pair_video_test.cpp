// SPDX-License-Identifier: Apache-2.0
// Real depth video, read as pairs to the bit.
#include <gtest/gtest.h>

#include <filesystem>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"
#include "tests/unit/media/pairs/pairs_read.h"

namespace relievo {
namespace {

using test::sampleAt;

std::string data(const std::string& name) {
  return std::string(RELIEVO_TEST_DATA) + "/" + name;
}
#define RELIEVO_NEEDS(file) \
  if (!std::filesystem::exists(data(file))) GTEST_SKIP() << data(file) << " is not here"

TEST(PairReaderRealVideo, CupIsPairedToTheEnd) {
  RELIEVO_NEEDS("cup/color_output.webm");
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(
      reader.open({.url = data("cup/color_output.webm"), .depth_url = data("cup/depth_output.webm")}).has_value());
  EXPECT_EQ(reader.info().color_width, 512);
  EXPECT_EQ(reader.info().color_height, 512);
  EXPECT_EQ(reader.info().depth_width, 288);
  EXPECT_EQ(reader.info().depth_height, 512);
  EXPECT_EQ(reader.info().calibration.calibration.range, ColorRange::Limited);
  std::uint64_t pairs = 0;
  while (const auto pair = reader.next().value()) {
    ++pairs;
    ASSERT_FALSE(pair->depth.empty());
    ASSERT_EQ(pair->depth.pts, pair->color.pts);
  }
  EXPECT_EQ(pairs, 581u);
  EXPECT_EQ(reader.counters().pairs, 581u);
  EXPECT_EQ(reader.counters().mismatched, 0u);
  EXPECT_EQ(reader.counters().depth_skipped, 0u);
  EXPECT_EQ(reader.counters().damaged, 0u);
}

TEST(PairReaderRealVideo, DeskIsColourOnTopAndHueBelow) {
  RELIEVO_NEEDS("desk/Test.mov");
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = data("desk/Test.mov"), .packing = Packing::TopBottom, .depth_code = DepthCode::Hue})
                  .has_value());
  EXPECT_EQ(reader.info().color_width, 512);
  EXPECT_EQ(reader.info().color_height, 424);
  EXPECT_EQ(reader.info().depth_height, 424);
  EXPECT_EQ(reader.info().color_codec, "hap");
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 48u);
  EXPECT_EQ(pairs[0].depth.model, ColorModel::Rgb);
  EXPECT_EQ(pairs[47].color.pts, mediaTime(47.0 / 24));
  // Two thirds of the depth have no reading and are black; the colour has no such areas.
  int black = 0;
  for (int r = 0; r < 424; ++r) {
    for (int c = 0; c < 512; ++c) {
      const Frame& d = pairs[20].depth;
      if (sampleAt(d, 0, c, r) + sampleAt(d, 1, c, r) + sampleAt(d, 2, c, r) <= 229) ++black;
    }
  }
  EXPECT_NEAR(black / (512.0 * 424.0), 0.67, 0.05);
}

TEST(PairReaderRealVideo, DeskIsKnownByItsHalves) {
  RELIEVO_NEEDS("desk/Test.mov");
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = data("desk/Test.mov")}).has_value());
  EXPECT_EQ(reader.info().packing, Packing::TopBottom);
  EXPECT_EQ(reader.info().calibration.calibration.code, DepthCode::Hue);
  EXPECT_EQ(reader.info().color_height, 424);
}

// The expected samples were read with another decoder.
TEST(PairReaderRealVideo, SixteenBitSurveysAreReadToTheBit) {
  RELIEVO_NEEDS("dome/02.png");
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = data("dome/%02d.png"), .depth_url = data("dome/%02d.png")}).has_value());
  EXPECT_EQ(reader.info().depth_width, 303);
  EXPECT_EQ(reader.info().calibration.calibration.bits, 16);
  EXPECT_EQ(reader.info().calibration.calibration.range, ColorRange::Full);
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 13u);
  for (const FramePair* pair : {&pairs.front(), &pairs.back()}) {  // the ground outside the crater does not move
    EXPECT_EQ(sampleAt(pair->depth, 0, 10, 20), 14323u);
    EXPECT_EQ(sampleAt(pair->depth, 0, 150, 221), 17876u);
    EXPECT_EQ(sampleAt(pair->depth, 0, 302, 441), 18490u);
  }
}

}  // namespace
}  // namespace relievo
