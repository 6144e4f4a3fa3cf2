// SPDX-License-Identifier: Apache-2.0
// What the names of pictures, and lists of them, say about their times.
#include "drivers/pictures/names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/pictures/lists.h"
#include "drivers/pictures/other_files.h"
#include "drivers/pictures/stereo.h"

namespace relievo {
namespace {

using pictures::NameKind;
using pictures::valuesOf;
using testing::ElementsAre;

// The names tell moments, in ns.
void expectMoments(const std::vector<std::string>& names, const std::vector<std::int64_t>& ns) {
  const auto told = valuesOf(names);
  EXPECT_EQ(told.kind, NameKind::Seconds) << names[0];
  EXPECT_EQ(told.values, ns) << names[0];
}

TEST(PictureNames, SecondsAreExact) {
  expectMoments({"1305031102.175304.png", "1305031102.2.png"}, {1305031102175304000, 1305031102200000000});
  expectMoments({"d-1294886362.665769-3143787185.pgm", "d-1294886362.793814-3151264321.pgm"},
                {1294886362665769000, 1294886362793814000});
  expectMoments({"1403636579763555584.png"}, {1403636579763555584});
  expectMoments({"1403636579763555.png"}, {1403636579763555000});
  expectMoments({"1403636579763.png"}, {1403636579763000000});
  expectMoments({"0000002-000000033369.jpg", "0000001-000000000000.jpg"}, {33369000, 0});
}

TEST(PictureNames, ARecordingsNumberMayStandBeforeItsSeconds) {
  expectMoments({"41069021_305.377.png", "41069021_306.010.png"}, {305377000000, 306010000000});  // ARKitScenes
}

// RealSense's rs-convert: milliseconds since 1970 with a fraction. HoloLens: 100 ns since 1601; .NET: since the year 1.
// 2021-06-30 20:05:40.3874938 is 1625083540.3874938 s after 1970.
TEST(PictureNames, OtherClocksCountAsWell) {
  expectMoments({"a_Depth_1625083540387.49380000000000.png", "a_Depth_1625083540420.50000000000000.png"},
                {1625083540387493800, 1625083540420500000});
  expectMoments({"132695571403874938.pgm", "132695571405874938.pgm"}, {1625083540387493800, 1625083540587493800});
  expectMoments({"637606803403874938.pgm"}, {1625083540387493800});
}

// InteriorNet; EuRoC's recorders. Numbers of photos are far apart, too, but not regularly.
TEST(PictureNames, NumbersThatAreFarApartAreNanosecondsOrMicroseconds) {
  expectMoments({"00000000000040000000.png", "00000000000000000000.png"}, {40000000, 0});
  expectMoments({"40000000.png", "120000000.png", "80000000.png"}, {40000000, 120000000, 80000000});
  expectMoments({"cam_33333.png", "cam_66667.png", "cam_166667.png"}, {33333000, 66667000, 166667000});
  expectMoments({"rgb_1403636579763555584.png", "rgb_1403636579813555456.png"},
                {1403636579763555584, 1403636579813555456});
  EXPECT_EQ(valuesOf({"0.png", "1000.png", "2000.png"}).kind, NameKind::Numbers);
  EXPECT_EQ(valuesOf({"397133.png", "37777.png", "252219.png", "87038.png"}).kind, NameKind::Numbers);
}

// Polycam's keyframes: microseconds, irregular; ms of a film of 30 pictures a second.
TEST(PictureNames, NumbersBeyondAnyCountAreTimesAndSoAreJitteringMilliseconds) {
  expectMoments({"435456552349.jpg", "435461133940.jpg", "435461500000.jpg", "435462000123.jpg", "435463200468.jpg",
                 "435463433679.jpg"},
                {435456552349000, 435461133940000, 435461500000000, 435462000123000, 435463200468000, 435463433679000});
  expectMoments({"435456552349.jpg", "435490552349.jpg"}, {435456552349, 435490552349});
  expectMoments({"100000.png", "100034.png", "100067.png", "100133.png", "100167.png"},
                {100000000000, 100034000000, 100067000000, 100133000000, 100167000000});
  EXPECT_EQ(valuesOf({"0.png", "33.png", "66.png", "132.png"}).kind, NameKind::Numbers) << "each 33rd";
}

TEST(PictureLists, WholeNumbersMayBeTimes) {
  const auto timeOf = [](const char* text) {
    const auto list = pictures::parsePictureList(text, 1);
    return list && !list->numbers ? list->lines.back().front().value : -1;
  };
  EXPECT_EQ(timeOf("1403636579763555584 a.png\n1403636579813555456 b.png\n"), 1403636579813555456);
  EXPECT_EQ(timeOf("1403636579763 a.png\n1403636579813 b.png\n"), 1403636579813000000);
  EXPECT_EQ(timeOf("0 a.png\n40000000 b.png\n120000000 c.png\n"), 120000000);
  EXPECT_EQ(timeOf("0 a.png\n40000.0 b.png\n80000 c.png\n"), 80000000);
  EXPECT_EQ(timeOf("7 a.png\n8.5 b.png\n9 c.png\n"), 9000000000) << "seconds";
  EXPECT_EQ(timeOf("7 a.png\n8 b.png\n9 c.png\n"), -1) << "numbers";
}

TEST(PictureNames, TheOnlyRunOfDigitsThatDiffersIsTheNumber) {
  const auto scene = valuesOf({"scene_1_10.png", "scene_1_9.png"});
  EXPECT_EQ(scene.kind, NameKind::Numbers);
  EXPECT_THAT(scene.values, ElementsAre(10, 9));
  EXPECT_THAT(valuesOf({"frame-000005.color.png"}).values, ElementsAre(5));
  const auto mixed = valuesOf({"b10.png", "a.png", "b9.png"});
  EXPECT_EQ(mixed.kind, NameKind::Ranks);
  EXPECT_THAT(mixed.values, ElementsAre(2, 0, 1)) << "in natural order";
  EXPECT_EQ(valuesOf({"1.png", "01.png"}).kind, NameKind::Ranks) << "one number twice";
}

TEST(PictureLists, OrderCommentsAndWhatIsNone) {
  const auto list = pictures::parsePictureList("# a comment\n\n2.5 depth/a.png 2.625 rgb/a.png # more\r\n", 2);
  ASSERT_TRUE(list);
  EXPECT_FALSE(list->numbers);
  ASSERT_EQ(list->lines.size(), 1u);
  EXPECT_EQ(list->lines[0][0].name, "depth/a.png");
  EXPECT_EQ(list->lines[0][1].value, 2625000000);
  const auto icl = pictures::parsePictureList("1 depth/1.png 1 rgb/1.png\n2 depth/2.png 2 rgb/2.png\n", 2);
  ASSERT_TRUE(icl);
  EXPECT_TRUE(icl->numbers);
  EXPECT_EQ(icl->lines[1][0].value, 2);
  for (const char* none :
       {"", "# nothing\n", "1 a.png\n", "1 a.png 2 b.txt\n", "x a.png 2 b.png\n", "-1 a.png 2 b.png\n",
        "1 a.png 2 b.png 3\n", "1e3 a.png 2 b.png\n", "99999999999 a.png 2 b.png\n", "1. a.png 1. b.png\n"}) {
    EXPECT_FALSE(pictures::parsePictureList(none, 2)) << none;
  }
}

// At 30 pictures a second the greater number would be 7.4e16 s after the other: 64 bits of ns hold 9.2e9 s.
// Its HDF5 files hold distances along rays, as its README says.
TEST(OtherFiles, HypersimsDistancesBecomeDepth) {
  EXPECT_THAT(pictures::wayToConvert("", "frame.0000.depth_meters.hdf5"), testing::HasSubstr("/ numpy.sqrt(1 + x * x"));
  EXPECT_THAT(pictures::wayToConvert("", "frame.0000.position.hdf5"), testing::Not(testing::HasSubstr("sqrt")));
}

TEST(OtherFiles, RawPicturesAreConvertedToAFilmOfTheirOwnFormat) {
  EXPECT_THAT(pictures::wayToConvert("", "v0_depth_320x240_yuv420p16le.yuv"), testing::HasSubstr("of 16 yuv420p16le"));
  EXPECT_THAT(pictures::wayToConvert("", "a.raw"), testing::HasSubstr("gray16le"));
}

TEST(PictureNames, GreatNumbersCountNoPictures) {
  EXPECT_EQ(valuesOf({"9000000000.png", "1.png"}).kind, NameKind::Numbers);
  const auto great = valuesOf({"2222222222222222222.png", "1.png"});
  EXPECT_EQ(great.kind, NameKind::Ranks);
  EXPECT_EQ(great.values, (std::vector<std::int64_t>{1, 0}));
}

TEST(StereoNames, ASeriesOfLeftAndRightIsTwoViews) {
  for (const std::vector<std::string>& names : {std::vector<std::string>{"l_1.png", "r_1.png", "l_2.png", "r_2.png"},
                                                {"1_L.png", "1_R.png", "2_L.png", "2_R.png"},
                                                {"im_left1.png", "im_right1.png", "im_left2.png", "im_right2.png"}}) {
    const auto views = pictures::viewsAmong(names);
    ASSERT_TRUE(views.has_value()) << names[0];
    EXPECT_THAT(views->left, ElementsAre(names[0], names[2]));
    EXPECT_THAT(views->right, ElementsAre(names[1], names[3]));
  }
  EXPECT_FALSE(pictures::viewsAmong({"l_1.png", "r_2.png"})) << "no pair";
  EXPECT_FALSE(pictures::viewsAmong({"l_1.png", "r_1.png", "cover.png"}));
  EXPECT_FALSE(pictures::viewsAmong({"color_1.png", "rail_1.png"}));
}

TEST(StereoNames, NumbersOfASeriesAreNoCameras) {
  const std::vector<std::string> series{"image_00.png", "image_01.png", "image_02.png", "image_03.png"};
  EXPECT_FALSE(pictures::stereoAmong(series, pictures::Named::Pictures).has_value());
  const auto cameras =
      pictures::stereoAmong({"image_00", "image_01", "image_02", "image_03"}, pictures::Named::Folders);
  ASSERT_TRUE(cameras.has_value());
  EXPECT_EQ(cameras->left + " " + cameras->right, "image_02 image_03");
}

TEST(PictureNames, DatesWithAFractionOfASecondAreTimes) {
  const auto us = valuesOf({"20230501_123015_900000.png", "20230501_123016_000000.png"});
  EXPECT_EQ(us.kind, NameKind::Seconds);
  ASSERT_EQ(us.values.size(), 2u);
  EXPECT_EQ(us.values[0], 1'682'944'215'900'000'000);  // date -u -d "2023-05-01 12:30:15" +%s
  EXPECT_EQ(us.values[1] - us.values[0], 100'000'000);
  const auto ms = valuesOf({"rgb_2023-05-01_12-30-15-005.png", "rgb_2023-05-01_12-30-15-105.png"});
  EXPECT_EQ(ms.kind, NameKind::Seconds);
  EXPECT_EQ(ms.values.back() - ms.values.front(), 100'000'000);
  EXPECT_NE(valuesOf({"20230501_123015_001.jpg", "20230501_124015_002.jpg"}).kind, NameKind::Seconds) << "photos";
}

}  // namespace
}  // namespace relievo
