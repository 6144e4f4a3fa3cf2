// SPDX-License-Identifier: Apache-2.0
// From depth codes to millimetres: grid, laws, ranges, holes and hue.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "app/scene/height_field.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/scene/code_height.h"

namespace relievo {
namespace {

using test::heightOf;
using test::kVolume;

TEST(GridMapping, PutsPixelCentresWhereTheSceneFrameSays) {
  const GridMapping grid(kVolume, 720, 486);
  EXPECT_DOUBLE_EQ(grid.x(0), (0.5 / 720 - 0.5) * 160);
  EXPECT_DOUBLE_EQ(grid.y(0), (0.5 - 0.5 / 486) * 108);
  EXPECT_NEAR(grid.x(719), 80 - 160 / 1440.0, 1e-12);
  EXPECT_NEAR(grid.u(0), 359.5, 1e-12);
  EXPECT_NEAR(grid.v(grid.y(17)), 17, 1e-12);
}

TEST(DisplayVolume, TakesItsHeightFromTheShapeOfThePicture) {
  EXPECT_DOUBLE_EQ(DisplayVolume::forPicture(720, 486).height_mm, 108);
  EXPECT_DOUBLE_EQ(DisplayVolume::forPicture(288, 512).height_mm, 160 * 512 / 288.0);
  EXPECT_DOUBLE_EQ(DisplayVolume::forPicture(720, 576, 16.0 / 15).height_mm, 120);
}

TEST(HeightField, LinearFullRangeSpansTheVolumeForEveryDepthOfBits) {
  for (const int bits : {8, 10, 12, 16}) {
    const std::uint32_t top = (1u << bits) - 1;
    EXPECT_DOUBLE_EQ(heightOf(0, bits, {.bits = bits}), 0);
    EXPECT_DOUBLE_EQ(heightOf(top, bits, {.bits = bits}), 40);
    EXPECT_NEAR(heightOf(top / 3, bits, {.bits = bits}), 40.0 * (top / 3) / top, 1e-12);
  }
}

TEST(HeightField, LimitedRangeMapsSixteenAndTwoThirtyFiveToTheEndsAndClampsBeyond) {
  const DepthCalibration limited{.range = ColorRange::Limited};
  EXPECT_DOUBLE_EQ(heightOf(16, 8, limited), 0);
  EXPECT_DOUBLE_EQ(heightOf(235, 8, limited), 40);
  EXPECT_DOUBLE_EQ(heightOf(3, 8, limited), 0);
  EXPECT_DOUBLE_EQ(heightOf(255, 8, limited), 40);
  EXPECT_NEAR(heightOf(100, 8, limited), 40.0 * 84 / 219, 1e-12);
  EXPECT_NEAR(heightOf(400, 10, {.range = ColorRange::Limited, .bits = 10}), 40.0 * 336 / 876, 1e-12);
}

TEST(HeightField, InverseLawIsLinearInDistanceNotInTheCode) {
  // near 500, far 1000: half way in disparity is 1/(0.5/500 + 0.5/1000) = 666.67 mm, 2/3 of the way from far to near.
  const DepthCalibration inverse{.law = DepthLaw::Inverse, .bits = 16, .near_mm = 500, .far_mm = 1000};
  EXPECT_NEAR(heightOf(0, 16, inverse), 0, 1e-9);
  EXPECT_NEAR(heightOf(65535, 16, inverse), 40, 1e-9);
  EXPECT_NEAR(heightOf(32768, 16, inverse), 40 * (1000 - 1 / (0.001 + 0.001 * 32768 / 65535.0)) / 500, 1e-9);
  EXPECT_NEAR(heightMm(inverse, 0.5, 40), 40 * 2 / 3.0, 1e-9);
}

TEST(HeightField, AgreesWithTheCalibrationFormulaOverEveryCode) {
  for (const DepthLaw law : {DepthLaw::Linear, DepthLaw::Inverse}) {
    for (const DepthPolarity polarity : {DepthPolarity::NearIsHigh, DepthPolarity::NearIsLow}) {
      const DepthCalibration c{.law = law, .polarity = polarity, .range = ColorRange::Limited};
      for (std::uint32_t code = 0; code < 256; ++code) {
        const double s = (code - c.lowCode()) / (c.highCode() - c.lowCode());
        ASSERT_NEAR(heightOf(code, 8, c), heightMm(c, s, 40), 1e-9) << code;
      }
    }
  }
}

TEST(HeightField, AnInvalidCodeIsAHoleWithWhichNoComparisonHolds) {
  const double z = heightOf(7, 8, {.invalid = 7});
  EXPECT_TRUE(std::isnan(z));
  EXPECT_FALSE(z < 1e9 || z >= -1e9);
  EXPECT_FALSE(std::isnan(heightOf(8, 8, {.invalid = 7})));
}

TEST(HeightField, ReadsPaddedRowsWordsWithShiftAndUpsideDownPictures) {
  std::vector<std::uint8_t> memory(64, 0xee);
  Frame frame;
  frame.width = 2;
  frame.height = 2;
  frame.components[0] = {.plane = 0, .offset_bytes = 2, .step_bytes = 4, .shift = 6, .bits = 10};
  frame.planes[0] = {memory.data(), 24};
  const auto put = [&](int c, int r, unsigned code) {
    const unsigned word = code << 6 | 0x2a;  // bits below the shift do not belong to the sample
    memory[static_cast<std::size_t>(r * 24 + 2 + c * 4)] = static_cast<std::uint8_t>(word);
    memory[static_cast<std::size_t>(r * 24 + 2 + c * 4 + 1)] = static_cast<std::uint8_t>(word >> 8);
  };
  put(0, 0, 1023);
  put(1, 0, 512);
  put(0, 1, 1);
  put(1, 1, 0);
  const auto field = HeightField::make(frame, {.bits = 10}, kVolume).value();
  EXPECT_EQ(field.code(0, 0), 1023u);
  EXPECT_EQ(field.code(1, 0), 512u);
  EXPECT_EQ(field.code(0, 1), 1u);
  EXPECT_DOUBLE_EQ(field.heightMm(1, 0), 40 * 512 / 1023.0);

  frame.planes[0] = {memory.data() + 24, -24};
  EXPECT_EQ(HeightField::make(frame, {.bits = 10}, kVolume).value().code(0, 0), 1u);
}

TEST(HeightField, DecodesHueWithNearAtRedAndHolesWhereItIsDark) {
  // red 0, yellow 60, green 120, cyan 180, blue 240, magenta 300 degrees; then two that cannot be read.
  std::vector<std::uint8_t> pixels{255, 0, 0,   0, 255, 255, 0,   0, 0,  255, 0, 0, 0,  255, 255, 0,
                                   0,   0, 255, 0, 255, 0,   255, 0, 40, 36,  0, 0, 90, 90,  90,  0};
  Frame frame;
  frame.width = 8;
  frame.height = 1;
  frame.model = ColorModel::Rgb;
  for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.plane = 0, .offset_bytes = i, .step_bytes = 4};
  frame.planes[0] = {pixels.data(), 32};
  const DepthCalibration hue{.polarity = DepthPolarity::NearIsLow, .code = DepthCode::Hue};
  const auto field = HeightField::make(frame, hue, kVolume).value();
  for (int c = 0; c < 6; ++c) EXPECT_NEAR(field.heightMm(c, 0), 40 * (1 - c / 6.0), 1e-12) << c;
  EXPECT_TRUE(std::isnan(field.heightMm(6, 0)));  // the bytes add up to 76: too dark
  EXPECT_TRUE(std::isnan(field.heightMm(7, 0)));  // gray has no hue
  pixels[24] = 41;                                // 77: readable
  EXPECT_FALSE(std::isnan(field.heightMm(6, 0)));
}

TEST(HeightField, TellsSamplesApartWhateverLiesBesideThem) {
  std::vector<std::uint8_t> one(96, 1), other(96, 1);
  const auto field = [](std::vector<std::uint8_t>& memory, int width) {
    Frame frame;
    frame.width = width;
    frame.height = 3;
    frame.components[0] = {.plane = 0, .offset_bytes = 2, .step_bytes = 4, .bits = 16};
    frame.planes[0] = {memory.data(), 32};
    return HeightField::make(frame, {.bits = 16}, kVolume).value();
  };
  const auto same = [&] { return field(one, 5).sameSamples(field(other, 5)); };
  EXPECT_TRUE(same());
  EXPECT_FALSE(field(one, 5).sameSamples(field(other, 4)));
  other[0] = other[2 + 4 * 4 + 2] = other[31] = 7;  // before the first sample of a row and after the last
  EXPECT_TRUE(same());
  other[2 * 32 + 2 + 4 * 4 + 1] = 7;  // the last byte of the last sample
  EXPECT_FALSE(same());
}

// What a chroma sample shows alone: U and V in planes of their own, of an odd picture whose last column and row have
// half a chroma sample each.
TEST(HeightField, TellsTheChromaOfHueApartToItsLastSample) {
  const auto field = [](const std::vector<std::uint8_t>& luma, const std::vector<std::uint8_t>& u,
                        const std::vector<std::uint8_t>& v) {
    Frame frame;
    frame.width = 5;
    frame.height = 3;
    frame.model = ColorModel::Yuv;
    frame.range = ColorRange::Full;
    frame.chroma_shift_x = frame.chroma_shift_y = 1;
    for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.plane = i, .step_bytes = 1, .bits = 8};
    frame.planes[0] = {luma.data(), 5};
    frame.planes[1] = {u.data(), 4};
    frame.planes[2] = {v.data(), 4};
    return HeightField::make(frame, {.polarity = DepthPolarity::NearIsLow, .code = DepthCode::Hue}, kVolume).value();
  };
  const std::vector<std::uint8_t> luma(15, 100), one(8, 90);
  std::vector<std::uint8_t> other = one;
  EXPECT_TRUE(field(luma, one, one).sameSamples(field(luma, other, other)));
  other[3] = other[7] = 7;  // behind the three samples of either row
  EXPECT_TRUE(field(luma, one, one).sameSamples(field(luma, other, other)));
  other[6] = 7;  // the last sample of the last row
  EXPECT_FALSE(field(luma, one, one).sameSamples(field(luma, other, one)));
  EXPECT_FALSE(field(luma, one, one).sameSamples(field(luma, one, other)));
}

// A pixel of YUV, its luma and chroma in words of 16 bits of which the upper 10 count (P010), or in bytes.
double hueHeightMm(std::array<int, 3> yuv, ColorRange range, bool upper_ten, const DepthCalibration& calibration) {
  std::vector<std::uint8_t> bytes;
  for (const int code : yuv) {
    const int word = code << 8 | (upper_ten ? 0x2a : 0);  // what lies below the ten bits is not the sample's
    if (upper_ten) bytes.push_back(static_cast<std::uint8_t>(word & 0x3f));
    bytes.push_back(static_cast<std::uint8_t>(code));
  }
  Frame frame;
  frame.width = frame.height = 1;
  frame.model = ColorModel::Yuv;
  frame.range = range;
  frame.matrix = ColorMatrix::Bt601;
  const int step = upper_ten ? 2 : 1;
  for (std::uint8_t i = 0; i < 3; ++i) {
    frame.components[i] = {.plane = i,
                           .step_bytes = static_cast<std::uint8_t>(step),
                           .shift = static_cast<std::uint8_t>(upper_ten ? 6 : 0),
                           .bits = static_cast<std::uint8_t>(upper_ten ? 10 : 8)};
    frame.planes[i] = {bytes.data() + step * i, step};
  }
  return HeightField::make(frame, calibration, kVolume).value().heightMm(0, 0);
}

// Green of BT.601 is (150, 44, 21) in full range and (145, 54, 34) in limited range: a third of the way round.
TEST(HeightField, HueOverYuvIsReadInItsRangeAndInTenBitsOfSixteen) {
  const DepthCalibration hue{.polarity = DepthPolarity::NearIsLow, .code = DepthCode::Hue};
  for (const bool upper_ten : {false, true}) {
    EXPECT_NEAR(hueHeightMm({150, 44, 21}, ColorRange::Full, upper_ten, hue), 40 * 2 / 3.0, 0.2) << upper_ten;
    EXPECT_NEAR(hueHeightMm({145, 54, 34}, ColorRange::Limited, upper_ten, hue), 40 * 2 / 3.0, 0.2) << upper_ten;
  }
  // Too dark (the brightest component is 60), and too pale (the palest component is half of it): no reading, although
  // the hue is green.
  EXPECT_TRUE(std::isnan(hueHeightMm({35, 108, 103}, ColorRange::Full, false, hue))) << "(0, 60, 0)";
  EXPECT_TRUE(std::isnan(hueHeightMm({202, 86, 74}, ColorRange::Full, false, hue))) << "(127, 255, 128)";
}

// Red is code 0, yellow 256, green 512. Holes of several codes and ranges may be named for a hue as well, beyond what 8
// bits hold.
TEST(HeightField, ACodeOfAHueMayBeAHole) {
  std::vector<std::uint8_t> pixels{255, 0, 0, 255, 255, 0, 0, 255, 0, 9, 9, 9};
  Frame frame;
  frame.width = 4;
  frame.height = 1;
  frame.model = ColorModel::Rgb;
  for (std::uint8_t i = 0; i < 3; ++i)
    frame.components[i] = {.plane = 0, .offset_bytes = i, .step_bytes = 3, .bits = 8};
  frame.planes[0] = {pixels.data(), 12};
  const auto choice = chooseCalibration({.command_line = {{"invalid", "0+500-520"}}}, frame, DepthCode::Hue);
  ASSERT_TRUE(choice) << choice.error().message;
  const auto field = HeightField::make(frame, choice->calibration, kVolume).value();
  EXPECT_TRUE(std::isnan(field.heightMm(0, 0)));
  EXPECT_NEAR(field.heightMm(1, 0), 40 * 5 / 6.0, 1e-9);
  EXPECT_TRUE(std::isnan(field.heightMm(2, 0)));
  EXPECT_EQ(field.code(1, 0), 256u);
  EXPECT_EQ(field.code(3, 0), 0u) << "gray has no hue";
}

TEST(HeightField, RefusesAPictureThatItsCodeCannotLieIn) {
  Frame gray = test::makeGrayFrame(2, 2, 8, {}, [](int, int) { return 1; });
  EXPECT_EQ(HeightField::make(gray, {.code = DepthCode::Hue}, kVolume).error().code, ErrorCode::Unsupported);
  EXPECT_EQ(HeightField::make(Frame{}, {}, kVolume).error().code, ErrorCode::InvalidArgument);
  // RGB whose components lie in planes of their own, or have 16 bits.
  Frame rgb = gray;
  rgb.model = ColorModel::Rgb;
  for (auto& component : rgb.components) component = {.step_bytes = 1, .bits = 8};
  EXPECT_EQ(HeightField::make(rgb, {.code = DepthCode::Hue}, kVolume).error().code, ErrorCode::Unsupported);
  for (auto& component : rgb.components) component = {.step_bytes = 6, .bits = 16};
  EXPECT_EQ(HeightField::make(rgb, {.code = DepthCode::Hue}, kVolume).error().code, ErrorCode::Unsupported);
}

}  // namespace
}  // namespace relievo
