// SPDX-License-Identifier: Apache-2.0
// Depth of any kind as 8-bit codes: rescaling, ranges, polarity, hue, holes; every number worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "app/author/package/depth_coder.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

using Codes = std::vector<int>;

constexpr DepthCoding kLossless{.crf = 0};

Frame grayRow(const Codes& codes, int bits) {
  return test::makeGrayFrame(static_cast<int>(codes.size()), 1, bits, MediaTime{},
                             [&](int c, int) { return codes[static_cast<std::size_t>(c)]; });
}

Codes coded(const Frame& frame, const DepthCalibration& calibration, const DepthCoding& coding = kLossless) {
  DepthCoder coder(calibration, coding);
  DepthPicture picture;
  EXPECT_TRUE(coder.encode(frame, picture).has_value());
  EXPECT_EQ(picture.width, frame.width);
  EXPECT_EQ(picture.height, frame.height);
  return {picture.codes.begin(), picture.codes.end()};
}

TEST(AuthorDepthCoder, LeavesEightBitsOfFullRangeAsTheyAre) {
  Codes all(256);
  for (int i = 0; i < 256; ++i) all[static_cast<std::size_t>(i)] = i;
  EXPECT_EQ(coded(grayRow(all, 8), {}), all);
  EXPECT_TRUE(DepthCoder({}).explain().empty());
}

// 65535 = 255 x 257, so code c is c/257: 128/257 = 0.498, 129/257 = 0.502, 385/257 = 1.498, 386/257 = 1.502,
// 32639/257 = 127 exactly, 32767/257 = 127.498, 32768/257 = 127.502.
TEST(AuthorDepthCoder, RoundsSixteenBitsToTheNearestOfEight) {
  const Codes wide{0, 128, 129, 257, 385, 386, 32639, 32767, 32768, 65406, 65407, 65535};
  EXPECT_EQ(coded(grayRow(wide, 16), {.bits = 16}), (Codes{0, 0, 1, 1, 1, 2, 127, 127, 128, 254, 255, 255}));
}

// 255 c/1023: 2 -> 0.499, 3 -> 0.748, 511 -> 127.4, 512 -> 127.6, 1021 -> 254.50 (254.501), 1020 -> 254.25.
TEST(AuthorDepthCoder, RoundsTenBits) {
  EXPECT_EQ(coded(grayRow({0, 2, 3, 511, 512, 1020, 1021, 1023}, 10), {.bits = 10}),
            (Codes{0, 0, 1, 127, 128, 254, 255, 255}));
}

// (c - 16) 255/219: 17 -> 1.16, 18 -> 2.33, 126 -> 128.08, 234 -> 253.84; footroom is 0, headroom is 255.
TEST(AuthorDepthCoder, ExpandsLimitedRangeToFull) {
  const DepthCalibration limited{.range = ColorRange::Limited};
  EXPECT_EQ(coded(grayRow({0, 15, 16, 17, 18, 126, 234, 235, 240, 255}, 8), limited),
            (Codes{0, 0, 0, 1, 2, 128, 254, 255, 255, 255}));
}

// 10 bits limited: 64 .. 940, 876 steps; 255/876 = 0.291: 65 -> 0.29, 66 -> 0.58, 502 -> 438 x 255/876 = 127.5 exactly,
// rounded up.
TEST(AuthorDepthCoder, ExpandsLimitedTenBits) {
  const DepthCalibration limited{.range = ColorRange::Limited, .bits = 10};
  EXPECT_EQ(coded(grayRow({0, 64, 65, 66, 502, 940, 1023}, 10), limited), (Codes{0, 0, 0, 1, 128, 255, 255}));
}

TEST(AuthorDepthCoder, TurnsNearLowRound) {
  const DepthCalibration low{.polarity = DepthPolarity::NearIsLow};
  EXPECT_EQ(coded(grayRow({0, 1, 100, 254, 255}, 8), low), (Codes{255, 254, 155, 1, 0}));
  EXPECT_EQ(DepthCoder(low).outcome().polarity, DepthPolarity::NearIsHigh);
}

TEST(AuthorDepthCoder, GivesHolesACodeOfTheirOwn) {
  // 16 bits, 0 is a hole: 1 and 128 would round to 0 but must not become holes.
  const DepthCalibration source{.bits = 16, .invalid = 0};
  EXPECT_EQ(coded(grayRow({0, 1, 128, 386, 65535}, 16), source), (Codes{0, 1, 1, 2, 255}));

  DepthCoder coder(source, kLossless);
  DepthPicture picture;
  ASSERT_TRUE(coder.encode(grayRow({0, 0, 1, 65535}, 16), picture).has_value());
  EXPECT_EQ(coder.outcome().invalid, CodeSet(0));
  EXPECT_EQ(coder.outcome().bits, 8);
  EXPECT_EQ(coder.counts().holes, 2u);
  EXPECT_EQ(coder.counts().samples, 4u);
  EXPECT_EQ(coder.counts().of_code[0], 0u);
  EXPECT_EQ(coder.counts().of_code[1], 1u);
  EXPECT_EQ(coder.counts().of_code[255], 1u);
}

// 8 of 256 codes are holes, and depth begins at 16: 16 + 239 s. A code that a codec has moved by 7 still means the
// same.
TEST(AuthorDepthCoder, KeepsHolesApartFromDepthWhereTheCodecMovesCodes) {
  const DepthCalibration source{.bits = 16, .invalid = 0};
  const DepthCoding lossy{.crf = 8};
  EXPECT_EQ(coded(grayRow({0, 1, 13107, 32768, 65535}, 16), source, lossy), (Codes{0, 16, 64, 136, 255}));
  const DepthCalibration outcome = DepthCoder(source, lossy).outcome();
  EXPECT_EQ(outcome.invalid.text(), "0-7");
  EXPECT_EQ(outcome.codes, (CodeSet::Range{16, 255}));
  EXPECT_EQ(DepthCoder(source, {.bits = 10, .crf = 8}).outcome().codes, (CodeSet::Range{64, 1023}));
  EXPECT_FALSE(DepthCoder({.bits = 16}, lossy).outcome().codes) << "no holes";
}

// In a film of the author's, coding has moved holes and far samples into the codes between them.
TEST(AuthorDepthCoder, CodesBetweenABandOfHolesAndTheRangeAreNotClipped) {
  const auto clipped = [](const CodeSet& holes) {
    DepthCoder coder({.invalid = holes, .codes = CodeSet::Range{16, 250}}, kLossless);
    DepthPicture picture;
    EXPECT_TRUE(coder.encode(grayRow({0, 7, 9, 15, 16, 250, 251}, 8), picture));
    return coder.counts().clipped;
  };
  EXPECT_EQ(clipped(CodeSet(CodeSet::Range{0, 7})), 1U);  // 251
  EXPECT_EQ(clipped(CodeSet(0)), 4U);                     // 7, 9 and 15 as well
}

TEST(AuthorDepthCoder, MovesAHoleFromAnyCodeToZero) {
  const DepthCalibration source{.invalid = 255};
  EXPECT_EQ(coded(grayRow({0, 7, 254, 255}, 8), source), (Codes{1, 7, 254, 0}));
}

TEST(AuthorDepthCoder, KeepsZeroForDepthWhereThereAreNoHoles) {
  EXPECT_TRUE(DepthCoder(DepthCalibration{.bits = 16}).outcome().invalid.empty());
}

TEST(AuthorDepthCoder, KeepsTheLaw) {
  const DepthCalibration source{.law = DepthLaw::Inverse, .bits = 12, .near_mm = 300, .far_mm = 4000};
  const DepthCalibration outcome = DepthCoder(source).outcome();
  EXPECT_EQ(outcome.law, DepthLaw::Inverse);
  EXPECT_EQ(outcome.near_mm, 300);
  EXPECT_EQ(outcome.far_mm, 4000);
  // The code depends on s alone, not on the law: 255 x 1365/4095 = 85.
  EXPECT_EQ(coded(grayRow({1365}, 12), source), Codes{85});
}

// Hue over 360 degrees grows with distance: red 0 is the nearest, 255; yellow 1/6 -> 255 x 5/6 = 212.5; green 1/3 ->
// 170; cyan 1/2 -> 127.5; blue 2/3 -> 85; magenta 5/6 -> 42.5; orange, half way from red to yellow, 1/12 -> 233.7.
// Black has no hue: a hole.
TEST(AuthorDepthCoder, DecodesHueToLuma) {
  static const std::uint8_t pixels[] = {255, 0, 0,   255, 255, 0,   0,   255, 0, 0, 255, 255,
                                        0,   0, 255, 255, 0,   255, 255, 128, 0, 0, 0,   0};
  Frame frame;
  frame.width = 8;
  frame.height = 1;
  frame.model = ColorModel::Rgb;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.planes[0] = {pixels, sizeof pixels};
  for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.plane = 0, .offset_bytes = i, .step_bytes = 3};

  const Codes codes = coded(frame, {.polarity = DepthPolarity::NearIsLow, .code = DepthCode::Hue});
  const double expected[] = {255, 212.5, 170, 127.5, 85, 42.5, 233.7};
  for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(codes[i], expected[i], 0.5 + 1e-9) << i;
  EXPECT_EQ(codes[7], 0);
  EXPECT_EQ(DepthCoder({.code = DepthCode::Hue}, kLossless).outcome().invalid, CodeSet(0));
}

// 65535 to 4095: 16.004 codes to one; 8 -> 0.4999, 9 -> 0.56, 32768 -> 2047.53. 10 to 12 bits: 4095/1023 = 4.003.
TEST(AuthorDepthCoder, KeepsAsManyBitsAsAreAskedFor) {
  const DepthCoding twelve{.codec = VideoCodec::Hevc, .bits = 12, .crf = 0};
  EXPECT_EQ(coded(grayRow({0, 8, 9, 32768, 65535}, 16), {.bits = 16}, twelve), (Codes{0, 0, 1, 2048, 4095}));
  EXPECT_EQ(coded(grayRow({0, 1, 512, 1023}, 10), {.bits = 10}, twelve), (Codes{0, 4, 2050, 4095}));
  const DepthCoding sixteen{.codec = VideoCodec::Ffv1, .bits = 16};
  EXPECT_EQ(coded(grayRow({0, 1, 32767, 65535}, 16), {.bits = 16}, sixteen), (Codes{0, 1, 32767, 65535}));
  EXPECT_TRUE(DepthCoder({.bits = 16}, sixteen).explain().empty());
  DepthCoder coder({.bits = 16, .invalid = 0}, twelve);
  DepthPicture picture;
  ASSERT_TRUE(coder.encode(grayRow({0, 1, 65535}, 16), picture).has_value());
  EXPECT_EQ(picture.codes, (std::vector<std::uint16_t>{0, 1, 4095}));
  EXPECT_EQ(coder.outcome().bits, 12);
  EXPECT_EQ(coder.counts().of_code.at(4095), 1u);
}

// Near 500, far 2000 mm. Half the height is 1250 mm away: (1/1250 - 1/2000)/(1/500 - 1/2000) = 0.2 of the codes, 51 of
// 255; code 51 of disparity is half the height, 127.5.
TEST(AuthorDepthCoder, ChangesTheLawAndKeepsTheHeights) {
  const DepthCalibration even{.bits = 16, .near_mm = 500, .far_mm = 2000};
  const DepthCoding by_disparity{.law = DepthLaw::Inverse};
  EXPECT_EQ(coded(grayRow({0, 32768, 65535}, 16), even, by_disparity), (Codes{0, 51, 255}));
  EXPECT_EQ(DepthCoder(even, by_disparity).outcome().law, DepthLaw::Inverse);
  const DepthCalibration inverse{.law = DepthLaw::Inverse, .near_mm = 500, .far_mm = 2000};
  EXPECT_EQ(coded(grayRow({0, 51, 255}, 8), inverse, {.law = DepthLaw::Linear}), (Codes{0, 128, 255}));
  EXPECT_EQ(coded(grayRow({0, 51, 255}, 8), inverse, by_disparity), (Codes{0, 51, 255}));
  // Near low: the same heights, from the other side.
  DepthCalibration low = even;
  low.polarity = DepthPolarity::NearIsLow;
  EXPECT_EQ(coded(grayRow({0, 32767, 65535}, 16), low, by_disparity), (Codes{255, 51, 0}));
}

TEST(AuthorDepthCoder, SaysWhatItDid) {
  const auto said = [](const DepthCalibration& c) {
    std::string all;
    for (const std::string& line : DepthCoder(c, kLossless).explain()) all += line + "\n";
    return all;
  };
  EXPECT_NE(said({.bits = 16}).find("16 bits rescaled to 8 bits: codes 0 .. 65535"), std::string::npos);
  EXPECT_NE(said({.range = ColorRange::Limited, .bits = 10}).find("codes 64 .. 940"), std::string::npos);
  EXPECT_NE(said({.range = ColorRange::Limited}).find("limited range expanded"), std::string::npos);
  EXPECT_NE(said({.polarity = DepthPolarity::NearIsLow}).find("polarity inverted"), std::string::npos);
  EXPECT_NE(said({.invalid = 3}).find("reserved for holes"), std::string::npos);
  EXPECT_NE(said({.code = DepthCode::Hue}).find("hue decoded"), std::string::npos);
  const DepthCoder lossy({.bits = 16, .invalid = 0}, {.crf = 8});
  EXPECT_NE(lossy.explain().at(0).find("codes 0 .. 65535 to 16 .. 255"), std::string::npos) << lossy.explain().at(0);
  EXPECT_NE(DepthCoder({}, {.law = DepthLaw::Inverse}).explain().at(0).find("linear steps converted to inverse"),
            std::string::npos);
}

}  // namespace
}  // namespace relievo
