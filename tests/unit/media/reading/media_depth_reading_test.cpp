// SPDX-License-Identifier: Apache-2.0
// Recordings without calibration: what is read off their first picture, and which doubts are reported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/media/pair_reader.h"
#include "app/media/reading/depth_doubts.h"
#include "app/media/reading/depth_meaning.h"
#include "app/media/reading/depth_reading.h"
#include "app/media/reading/picture_look.h"
#include "app/scene/height_field.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/film/ffmpeg_backends.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::distanceMm;
using test::hueColor;
using test::makeClip;
using test::makeGrayFrame;
using test::TemporaryFolder;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::Not;

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr int kCols = test::kSceneCols, kRows = test::kSceneRows;

// A 16-bit picture with code(mm) for each distance.
template <class Code>
Frame picture(std::uint32_t hole, Code&& code) {
  return makeGrayFrame(kCols, kRows, 16, {}, [&](int c, int r) {
    const double mm = distanceMm(c, r);
    return mm == 0 ? hole : static_cast<std::uint32_t>(std::lround(code(mm)));
  });
}

DepthCalibration readingOf(const Frame& frame, const CalibrationLayers& said = {}) {
  CalibrationLayers layers = said;
  layers.pictures = readCodes(frame, CodeCount(frame), said).settings;
  return chooseCalibration(layers, frame, DepthCode::Luma).value().calibration;
}

// The distance of a height, by the definition in app/scene/depth_calibration.h: z = D (far - Z)/(far - near), for both
// laws.
double distanceOf(double height_mm, const DepthCalibration& c) {
  return c.far_mm - height_mm / kVolume.depth_mm * (c.far_mm - c.near_mm);
}

// Near is high, holes are holes, and every distance is exact to within `error_mm`.
void expectTrue(const Frame& frame, double error_mm, const std::string& name) {
  const DepthCalibration c = readingOf(frame);
  const HeightField field = HeightField::make(frame, c, kVolume).value();
  for (int r = 0; r < kRows; ++r) {
    for (int x = 0; x < kCols; ++x) {
      const double mm = distanceMm(x, r), height = field.heightMm(x, r);
      ASSERT_EQ(std::isnan(height), mm == 0) << name << " at " << x << ", " << r;
      if (mm == 0) continue;
      ASSERT_NEAR(distanceOf(height, c), mm, error_mm) << name << " at " << x << ", " << r;
    }
  }
}

TEST(DepthReading, SensorsCodesAreDistances) {
  expectTrue(picture(0, [](double mm) { return mm; }), 0.51, "mm, holes of 0");
  expectTrue(picture(65535, [](double mm) { return mm; }), 0.51, "mm, holes of 65535");
  const Frame sun = picture(0, [](double mm) { return std::floor(mm) * 8; });
  ASSERT_EQ(sensorKind(sun, CodeCount(sun)), findKind("sun"));
  expectTrue(inOrder(sun, SampleOrder::RotatedLeft3).value(), 1.01, "mm, rotated left by three bits");
}

// The lower bits, which number the people in view, mark the ball.
TEST(DepthReading, AKinectsPlayersStandBelowItsDistances) {
  const Frame players = picture(0, [](double mm) { return std::floor(mm) * 8 + (mm < 1400 ? 2 : 0); });
  ASSERT_EQ(sensorKind(players, CodeCount(players)), findKind("kinect-players"));
  expectTrue(inOrder(players, SampleOrder::Upper13).value(), 1.01, "mm above a player's number");
  // Read so, the ball would be 275 mm away, nearer than a Kinect sees.
  const Frame near = picture(0, [](double mm) { return std::floor(mm / 4) * 8 + (mm < 1400 ? 2 : 0); });
  EXPECT_EQ(sensorKind(near, CodeCount(near)), findKind("mm"));
  // In SUN RGB-D's coding, the upper bits wrap around beyond 8.19 m.
  const Frame far = picture(0, [](double mm) {
    const auto code = static_cast<std::uint32_t>(5 * mm);
    return static_cast<double>((code << 3 | code >> 13) & 0xffff);
  });
  EXPECT_EQ(sensorKind(far, CodeCount(far)), findKind("sun"));
}

// The formula for a Kinect's raw disparities in depth_reading.cpp, inverted: code = 1092.5 - 351300/z.
// Some recorders write 2048 for a hole.
TEST(DepthReading, ElevenBitsWithAHoleOf2047AreTheDisparitiesOfAKinect) {
  for (const std::uint32_t hole : {2047U, 2048U}) {
    const Frame raw = picture(hole, [](double mm) { return 1092.5 - 351300 / mm; });
    const DepthCalibration c = readingOf(raw);
    EXPECT_EQ(c.law, DepthLaw::Inverse) << hole;
    EXPECT_EQ(c.polarity, DepthPolarity::NearIsLow) << hole;
    expectTrue(raw, 0.5 * 2000 * 2000 / 351300 + 1, "raw disparities");  // half a code at 2 m
  }
}

// Five codes per millimetre, as in the TUM datasets, up to 9.8 m: more than half of the codes, with a gap.
TEST(DepthReading, DistancesOfAnotherUnitHaveTheSameRelief) {
  const Frame fine = picture(0, [](double mm) { return 5 * mm + 30000; });
  const DepthCalibration c = readingOf(fine);
  EXPECT_EQ(c.unit_mm, 0.2);
  const HeightField field = HeightField::make(fine, c, kVolume).value();
  EXPECT_TRUE(std::isnan(field.heightMm(2, 50)));
  EXPECT_GT(field.heightMm(kCols / 2, kRows / 2), field.heightMm(kCols - 2, 2));
}

// A scene from 0.5 to 16 m in mm. At 5000 codes a metre it would begin at 0.1 m.
TEST(DepthReading, WhatNoSensorSeesSoNearIsInMillimetres) {
  const auto kind = [](std::uint32_t nearest) {
    const Frame f = makeGrayFrame(kCols, kRows, 16, {}, [=](int c, int r) {
      const auto mm = static_cast<std::uint32_t>(8 * distanceMm(c, r));
      return c > 140 ? nearest + static_cast<std::uint32_t>(r) : mm;
    });
    return std::string(sensorKind(f, CodeCount(f))->name);
  };
  EXPECT_EQ(kind(500), "mm");
  EXPECT_EQ(kind(2500), "tum");
}

// A network leaves no hole, a sensor does.
TEST(DepthReading, DistancesWithoutAHoleMayHave256CodesAMetre) {
  const auto offer = [](std::uint32_t lift) {
    const Frame f = makeGrayFrame(kCols, kRows, 16, {},
                                  [=](int c, int r) { return lift + static_cast<std::uint32_t>(distanceMm(c, r)); });
    return readCodes(f, CodeCount(f), {}).offer;
  };
  EXPECT_THAT(offer(400), HasSubstr("if there are 256 codes a metre: --as zoedepth"));
  EXPECT_THAT(offer(6000), HasSubstr("--as zoedepth"));
  EXPECT_THAT(offer(0), Not(HasSubstr("zoedepth")));
}

// Holes tell a sensor from a network, not distances from disparities.
TEST(DepthReading, HighCodesMayBeDisparities) {
  const auto offer = [](double times) {
    const Frame f = picture(0, [=](double z) { return times * z; });
    return readCodes(f, CodeCount(f), {}).offer;
  };
  EXPECT_THAT(offer(5), HasSubstr("--as kitti-disparity"));
  EXPECT_THAT(offer(1), Not(HasSubstr("disparit")));
}

// No picture says which distances the first and the last hue mean, nor whether the hues are even in 1/distance.
TEST(DepthReading, HuesOfUnknownMeaningSayTheWords) {
  TemporaryFolder folder;
  ClipTrack hues{.codec = "png", .pix_fmt = "rgb24", .width = kCols, .height = kRows, .frames = 1};
  hues.sample = [](int k, int c, int r, int) {
    const double mm = distanceMm(c, r), part = hueColor(0.1 + 0.35 * mm / 1000).at(static_cast<std::size_t>(k));
    return static_cast<std::uint32_t>(mm == 0 ? 0 : std::lround(255 * part));
  };
  makeClip(folder / "a.png", {hues});
  const auto opened = [&](SourceOptions options) {
    options.url = folder / "a.png";
    PairReader reader(kFfmpeg);
    EXPECT_TRUE(reader.open(options));
    return reader.info();
  };
  const auto offers = [&](const SourceOptions& options) { return opened(options).reading.offers; };
  EXPECT_THAT(opened({}).notes, Contains(HasSubstr("--packing depth-alone")));
  EXPECT_THAT(offers({.packing = Packing::DepthAlone}),
              Contains(AllOf(HasSubstr("--as realsense-disparity"), HasSubstr("near=MM,far=MM"))));
  EXPECT_THAT(opened({.packing = Packing::DepthAlone}).reading.doubts, Contains(HasSubstr("polarity=near-high")));
  const KnownKind* const kind = findKind("realsense-disparity");
  EXPECT_THAT(offers({.packing = Packing::DepthAlone, .as = kind}),
              Contains(AllOf(HasSubstr("near=MM,far=MM"), Not(HasSubstr("polarity")))));
  EXPECT_THAT(offers({.packing = Packing::DepthAlone, .as = kind, .command_line = {{"near", "600"}, {"far", "2400"}}}),
              IsEmpty());
}

TEST(DepthReading, WhatIsStretchedOverItsBitsIsLeftAsItIs) {
  const auto settings = [](const Frame& f) { return readCodes(f, CodeCount(f), {}).settings; };
  const auto slope = [](int bits, std::uint32_t times) {
    return makeGrayFrame(256, 8, bits, {}, [=](int c, int) { return static_cast<std::uint32_t>(c) * times; });
  };
  EXPECT_THAT(settings(slope(16, 257)), IsEmpty());
  EXPECT_THAT(settings(makeGrayFrame(60, 8, 16, {}, [](int c, int) { return 1000 + 1024 * c; })), IsEmpty());
  EXPECT_THAT(settings(slope(16, 256)), IsEmpty());
  EXPECT_THAT(settings(slope(8, 1)), IsEmpty());
  EXPECT_THAT(settings(slope(12, 16)), IsEmpty());
}

TEST(DepthReading, WhoHasSaidWhatACodeIsGoesFirst) {
  const Frame mm = picture(0, [](double z) { return z; });
  for (const char* key : {"law", "polarity", "range", "codes", "unit"}) {
    CalibrationLayers layers;
    layers.tags = {{key, "linear"}};
    EXPECT_THAT(readCodes(mm, CodeCount(mm), layers).settings, Not(Contains(Key("unit")))) << key;
  }
  const DepthCalibration c = readingOf(mm, {.command_line = {{"near", "900"}, {"far", "2500"}}});
  EXPECT_EQ(c.unit_mm, 1.0);
  EXPECT_EQ(c.near_mm, 900);
  EXPECT_EQ(c.far_mm, 2500);
}

// What a camera shows next may be nearer than its first picture.
TEST(DepthReading, NearAndFarOfACameraAreNotReadOffItsFirstPicture) {
  const Frame mm = picture(0, [](double z) { return z; });
  DepthClues clues;
  clues.tags = {{"DEPTH_UNIT", "1"}, {"DEPTH_INVALID", "0"}};
  const auto nearOf = [&] { return readMeaning(clues, kindOf(clues, mm), mm).value().calibration.calibration.near_mm; };
  EXPECT_NEAR(nearOf(), 0.9 * 1100, 15);
  clues.live = true;
  EXPECT_EQ(nearOf(), 500);
}

TEST(DepthReading, AnUntaggedFilmThatUsesAllOfItsCodesIsOfTheFullRange) {
  Frame frame = makeGrayFrame(256, 8, 8, {}, [](int c, int) { return c; });
  frame.model = ColorModel::Yuv;
  frame.range = ColorRange::Unspecified;
  EXPECT_EQ(readCodes(frame, CodeCount(frame), {}).settings.at("range"), "full");
  frame.range = ColorRange::Limited;  // signalled
  EXPECT_THAT(readCodes(frame, CodeCount(frame), {}).settings, IsEmpty());
  Frame limited = makeGrayFrame(220, 8, 8, {}, [](int c, int) { return 16 + c; });
  limited.model = ColorModel::Yuv;
  limited.range = ColorRange::Unspecified;
  EXPECT_THAT(readCodes(limited, CodeCount(limited), {}).settings, IsEmpty());
}

TEST(DepthReading, DoubtsWhatCannotBeRight) {
  const auto doubts = [](const Frame& f, const DepthCalibration& c) { return doubtsOf(f, c); };
  const Frame slope = makeGrayFrame(256, 8, 8, {}, [](int c, int) { return c; });
  EXPECT_THAT(doubts(slope, {}), IsEmpty());
  const Frame even = makeGrayFrame(256, 8, 8, {}, [](int, int) { return 7; });
  EXPECT_THAT(doubts(even, {}), Contains(HasSubstr("100 % of the depth is one code")));
  EXPECT_THAT(doubts(even, {.invalid = 7}), Contains(HasSubstr("the whole depth picture is holes")));
  const Frame flat = makeGrayFrame(256, 8, 8, {}, [](int c, int) { return 100 + c % 10; });
  EXPECT_THAT(doubts(flat, {}), Contains(HasSubstr("uses only 3.5 % of the box's depth")));
  const Frame clipped = makeGrayFrame(256, 8, 8, {}, [](int c, int) { return std::min(2 * c, 255); });
  EXPECT_THAT(doubts(clipped, {}), Contains(HasSubstr("50 % of the depth lies at the near end")));
}

// In a rendered film the empty background around a thing has the same outline in depth and colour. The depth must not
// be taken for a second view because of that.
TEST(DepthReading, HolesAroundAThingAreNoSecondView) {
  const auto isThing = [](int c, int r) { return (c * c / 90 + r * r / 60) % 5 < 3; };
  const Frame color = makeGrayFrame(168, 96, 8, {}, [&](int c, int r) { return isThing(c, r) ? 200 : 20; });
  const auto depth = [&](std::uint32_t around) {
    return makeGrayFrame(168, 96, 16, {},
                         [&](int c, int r) { return isThing(c, r) ? 40000 + static_cast<std::uint32_t>(c) : around; });
  };
  EXPECT_THAT(doubtsOf(depth(0), {.bits = 16, .invalid = 0}, &color), Not(Contains(HasSubstr("the same picture"))));
  EXPECT_THAT(doubtsOf(depth(900), {.bits = 16}, &color), Contains(HasSubstr("the same picture")));
}

}  // namespace
}  // namespace relievo
