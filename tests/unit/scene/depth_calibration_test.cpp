// SPDX-License-Identifier: Apache-2.0
// What depth codes mean: how a calibration is written, which one holds where several do, and which are refused.
#include <gtest/gtest.h>

#include <cmath>

#include "app/scene/depth_calibration.h"
#include "tests/unit/scene/code_height.h"

namespace relievo {
namespace {

using test::heightOf;
using test::kVolume;

TEST(Calibration, ParsesCommandLinesAndSideFilesAndNamesWhatIsWrong) {
  const auto settings = parseCalibration(" law = inverse # comment\n near=400,far=2e3\n\n");
  ASSERT_TRUE(settings.has_value());
  EXPECT_EQ(settings->at("law"), "inverse");
  EXPECT_EQ(settings->at("far"), "2e3");
  EXPECT_EQ(settings->size(), 3u);
  for (const char* bad : {"colour=1", "law=cubic", "bits=7", "bits=17", "near=-1", "near=nan", "invalid=70000", "near",
                          "near=1e-4", "far=1e10", "near=700,far=600", "bits=10,invalid=1024"}) {
    EXPECT_EQ(parseCalibration(bad).error().code, ErrorCode::InvalidArgument) << bad;
  }
}

// Sensors mark missing readings by several codes: 0 and 65535, or all codes beyond the range.
TEST(Calibration, SeveralCodesAndRangesAreHoles) {
  const auto set = CodeSet::parse("0+2000-2047+65535");
  ASSERT_TRUE(set);
  for (const std::uint32_t hole : {0u, 2000u, 2020u, 2047u, 65535u}) EXPECT_TRUE(set->contains(hole)) << hole;
  for (const std::uint32_t code : {1u, 1999u, 2048u, 65534u}) EXPECT_FALSE(set->contains(code)) << code;
  EXPECT_EQ(set->text(), "0+2000-2047+65535");
  EXPECT_EQ(set->highest(), 65535u);
  EXPECT_EQ(CodeSet::parse("65535+3+2000-2047+0")->highest(), 65535u) << "four of them, in any order";
  EXPECT_EQ(CodeSet::parse("none")->text(), "none");
  for (const char* bad : {"", "0+", "+0", "9-3", "65536", "0+1+2+3+4", "-1", "0x10", "none+1"}) {
    EXPECT_FALSE(CodeSet::parse(bad)) << bad;
  }
  const auto height = [](std::uint32_t code) { return heightOf(code, 8, {.invalid = *CodeSet::parse("3+250-255")}); };
  EXPECT_TRUE(std::isnan(height(3)) && std::isnan(height(250)) && std::isnan(height(255)));
  EXPECT_FALSE(std::isnan(height(2)) || std::isnan(height(4)) || std::isnan(height(249)));
}

// A sensor of raw disparities uses the codes 400 to 1000 of 2048, which become the ends of the relief.
TEST(Calibration, CodesSayWhatTheReliefReachesFromAndTo) {
  const auto settings = parseCalibration("codes=400-1000,law=inverse,polarity=near-low,near=500,far=4000,bits=16");
  ASSERT_TRUE(settings);
  Frame frame;
  frame.components[0].bits = 16;
  const auto choice = chooseCalibration({.command_line = *settings}, frame, DepthCode::Luma);
  ASSERT_TRUE(choice) << choice.error().message;
  // Half way in 1/distance: 1/((1/500 + 1/4000)/2) = 888.9 mm, and (4000 - 888.9)/3500 of the volume.
  EXPECT_NEAR(heightOf(700, 16, choice->calibration), kVolume.depth_mm * (4000 - 8000.0 / 9) / 3500, 1e-9);
  EXPECT_NEAR(heightOf(400, 16, choice->calibration), kVolume.depth_mm, 1e-9);
  EXPECT_NEAR(heightOf(2000, 16, choice->calibration), 0, 1e-9);
  EXPECT_NE(choice->explanation.find("codes=400-1000 (command line)"), std::string::npos);
  for (const char* bad : {"codes=5", "codes=9-3", "codes=1-70000", "bits=8,codes=0-256", "unit=1,codes=1-5"}) {
    EXPECT_EQ(parseCalibration(bad).error().code, ErrorCode::InvalidArgument) << bad;
  }
}

TEST(Calibration, OfOnesThatExcludeEachOtherTheWholeIsRefused) {
  Frame frame;
  frame.components[0].bits = 16;
  const CalibrationSettings camera{{"unit", "1"}, {"near", "400"}, {"far", "2000"}};
  const auto chosen = [&](const CalibrationSettings& command_line, const CalibrationSettings& tags) {
    return chooseCalibration({.command_line = command_line, .tags = tags}, frame, DepthCode::Luma);
  };
  const auto isRefused = [](const Result<CalibrationChoice>& choice) {
    return !choice && choice.error().code == ErrorCode::InvalidArgument;
  };
  EXPECT_TRUE(isRefused(chosen({{"codes", "1-900"}}, camera)));
  EXPECT_TRUE(isRefused(chosen({{"near", "700"}, {"far", "700"}}, {})));
  EXPECT_TRUE(parseCalibration("near=9000")) << "the film may say a larger far";
  frame.components[0].bits = 8;
  EXPECT_TRUE(isRefused(chosen({{"codes", "1-256"}}, {})));
}

// A hue is read from 0 to 1535 whatever range its luma has.
TEST(Calibration, AHueHasNoLimitedRange) {
  Frame frame;
  frame.model = ColorModel::Yuv;
  frame.range = ColorRange::Limited;
  const auto choice = chooseCalibration({}, frame, DepthCode::Hue);
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->calibration.lowCode(), 0);
  EXPECT_EQ(choice->calibration.highCode(), 1536);
}

// What is written anew has codes of its own, whatever the source's were.
TEST(Calibration, WhatIsWrittenAnewKeepsNeitherUnitNorCodesNorTheSourcesHoles) {
  const DepthCalibration kinect{.bits = 16, .invalid = *CodeSet::parse("0+2047"), .codes = CodeSet::Range{400, 1000}};
  const DepthCalibration sensor{.polarity = DepthPolarity::NearIsLow, .bits = 16, .unit_mm = 0.5};
  const DepthCalibration hue{.polarity = DepthPolarity::NearIsLow, .code = DepthCode::Hue};
  for (const DepthCalibration& source : {kinect, sensor, hue}) {
    const DepthCalibration written = recoded(source, 10);
    EXPECT_EQ(written.lowCode(), 0);
    EXPECT_EQ(written.highCode(), 1023);
    EXPECT_EQ(written.polarity, DepthPolarity::NearIsHigh);
  }
  EXPECT_EQ(recoded(kinect, 10).invalid, CodeSet(0));
  EXPECT_EQ(recoded(hue, 10).invalid, CodeSet(0)) << "dark pixels are holes";
  EXPECT_TRUE(recoded(sensor, 10).invalid.empty());
}

TEST(Calibration, TagsComeBackAsTheyWereWritten) {
  const DepthCalibration c{.law = DepthLaw::Inverse,
                           .polarity = DepthPolarity::NearIsLow,
                           .range = ColorRange::Limited,
                           .bits = 12,
                           .invalid = *CodeSet::parse("0+4000-4095"),
                           .codes = CodeSet::Range{1, 3999},
                           .near_mm = 520.7,
                           .far_mm = 1259.61};
  Frame frame;
  frame.components[0].bits = 12;
  const auto choice = chooseCalibration({.tags = calibrationFromTags(calibrationTags(c))}, frame, DepthCode::Luma);
  ASSERT_TRUE(choice.has_value());
  EXPECT_EQ(choice->origin, CalibrationOrigin::ContainerTags);
  EXPECT_EQ(choice->calibration.law, c.law);
  EXPECT_EQ(choice->calibration.polarity, c.polarity);
  EXPECT_EQ(choice->calibration.range, c.range);
  EXPECT_EQ(choice->calibration.bits, 12);
  EXPECT_EQ(choice->calibration.invalid, c.invalid);
  EXPECT_EQ(choice->calibration.codes, c.codes);
  EXPECT_DOUBLE_EQ(choice->calibration.near_mm, 520.7);
  EXPECT_DOUBLE_EQ(choice->calibration.far_mm, 1259.61);
}

// (far - Z)/(far - near) of the 40 mm, whatever the law of other codes.
TEST(Calibration, CodesThatAreDistancesReachFromNearToFar) {
  Frame frame;
  frame.components[0].bits = 16;
  const CalibrationSettings camera{{"unit", "0.5"}, {"invalid", "0"}, {"near", "400"}, {"far", "2000"}};
  const auto choice = chooseCalibration({.tags = camera}, frame, DepthCode::Luma);
  ASSERT_TRUE(choice) << choice.error().message;
  const DepthCalibration& c = choice->calibration;
  const struct {
    std::uint32_t code;
    double mm;
  } heights[] = {{800, kVolume.depth_mm},      {4000, 0}, {2400, kVolume.depth_mm / 2}, {100, kVolume.depth_mm},
                 {3200, kVolume.depth_mm / 4}, {65535, 0}};
  for (const auto& [code, mm] : heights) EXPECT_NEAR(heightOf(code, 16, c), mm, 1e-9) << code;
  EXPECT_TRUE(std::isnan(heightOf(0, 16, c)));
  const auto again = chooseCalibration({.tags = calibrationFromTags(calibrationTags(c))}, frame, DepthCode::Luma);
  EXPECT_EQ(again->calibration.unit_mm, 0.5);
  EXPECT_EQ(again->calibration.polarity, DepthPolarity::NearIsLow);
  EXPECT_EQ(chooseCalibration({.command_line = {{"unit", "none"}}, .tags = camera}, frame, DepthCode::Luma)
                ->calibration.unit_mm,
            std::nullopt);
  EXPECT_EQ(parseCalibration("unit=1,law=inverse").error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(parseCalibration("unit=0").error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(parseCalibration("unit=1,polarity=near-high").error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(chooseCalibration({.command_line = {{"unit", "1"}}}, frame, DepthCode::Hue).error().code,
            ErrorCode::InvalidArgument);
  EXPECT_EQ(
      chooseCalibration({.command_line = {{"law", "inverse"}}, .tags = camera}, frame, DepthCode::Luma).error().code,
      ErrorCode::InvalidArgument);
}

TEST(Calibration, TheCommandLineWinsOverTheFileOverTagsOverTheStream) {
  Frame frame;
  frame.model = ColorModel::Yuv;
  CalibrationLayers layers{.command_line = {{"near", "1"}},
                           .side_file = {{"near", "2"}, {"law", "inverse"}},
                           .tags = {{"near", "3"}, {"law", "linear"}, {"polarity", "near-low"}}};
  const auto choice = chooseCalibration(layers, frame, DepthCode::Luma).value();
  EXPECT_EQ(choice.calibration.near_mm, 1);
  EXPECT_EQ(choice.calibration.law, DepthLaw::Inverse);
  EXPECT_EQ(choice.calibration.polarity, DepthPolarity::NearIsLow);
  EXPECT_EQ(choice.origin, CalibrationOrigin::CommandLine);
  EXPECT_NE(choice.explanation.find("law=inverse (side file)"), std::string::npos) << choice.explanation;
  EXPECT_NE(choice.explanation.find("polarity=near-low (container tags)"), std::string::npos);
  EXPECT_NE(choice.explanation.find("far=5000 (default)"), std::string::npos);
}

TEST(Calibration, UnsignalledRangeIsLimitedForYuvAndFullForGrayAndFullRangeYuv) {
  Frame frame;
  frame.model = ColorModel::Yuv;
  EXPECT_EQ(chooseCalibration({}, frame, DepthCode::Luma)->calibration.range, ColorRange::Limited);
  frame.range = ColorRange::Full;
  EXPECT_EQ(chooseCalibration({}, frame, DepthCode::Luma)->calibration.range, ColorRange::Full);
  frame.range = ColorRange::Unspecified;
  frame.model = ColorModel::Gray;
  EXPECT_EQ(chooseCalibration({}, frame, DepthCode::Luma)->calibration.range, ColorRange::Full);
  frame.range = ColorRange::Limited;
  const auto choice = chooseCalibration({}, frame, DepthCode::Luma);
  EXPECT_EQ(choice->calibration.range, ColorRange::Limited);
  EXPECT_EQ(choice->origin, CalibrationOrigin::StreamSignalling);
}

TEST(Calibration, FarMustLieBehindNear) {
  const auto code = [](const CalibrationLayers& layers) {
    return chooseCalibration(layers, Frame{}, DepthCode::Luma).error().code;
  };
  EXPECT_EQ(code({.command_line = {{"near", "9000"}}}), ErrorCode::InvalidArgument);
  EXPECT_EQ(code({.command_line = {{"near", "600"}}, .tags = {{"far", "400"}}}), ErrorCode::InvalidArgument);
  // The command line is not at fault here.
  EXPECT_EQ(code({.command_line = {{"law", "inverse"}}, .side_file = {{"near", "9000"}}}), ErrorCode::Corrupt);
  EXPECT_EQ(code({.tags = {{"near", "9000"}}}), ErrorCode::Corrupt);
}

TEST(Calibration, WhatTheSamplesCannotHoldIsRefusedAndOfTagsLeftOut) {
  Frame frame;
  frame.components[0].bits = 8;
  const auto choose = [&](const CalibrationLayers& layers) {
    return chooseCalibration(layers, frame, DepthCode::Luma);
  };
  EXPECT_EQ(choose({.command_line = {{"invalid", "256"}}}).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(choose({.command_line = {{"bits", "10"}}}).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(choose({.side_file = {{"invalid", "300"}}}).error().code, ErrorCode::Corrupt);
  EXPECT_EQ(choose({.command_line = {{"invalid", "255"}}})->calibration.invalid, CodeSet(255));
  const auto left_out = choose({.tags = {{"bits", "16"}, {"invalid", "65535"}}});
  ASSERT_TRUE(left_out);
  EXPECT_EQ(left_out->calibration.bits, 8);
  EXPECT_TRUE(left_out->calibration.invalid.empty());
  // Twelve bits in samples of sixteen are common.
  frame.components[0].bits = 16;
  EXPECT_EQ(choose({.command_line = {{"bits", "12"}, {"invalid", "4095"}}})->calibration.bits, 12);
}

}  // namespace
}  // namespace relievo
