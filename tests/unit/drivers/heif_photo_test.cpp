// SPDX-License-Identifier: Apache-2.0
// HEIC portraits, put together box by box around pictures that FFmpeg has coded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <vector>

#include "drivers/heif/heif.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recording/heic_writer.h"

namespace relievo {
namespace {

constexpr int kCols = test::kHeicCols, kRows = test::kHeicRows;
constexpr double kLeast = 0.4, kMost = 2.5;  // disparities, 1/m

// The codes as they lie in the file: the phone was held upright, so that the stored picture is turned.
std::uint32_t disparityCode(int c, int r) {
  return static_cast<std::uint32_t>(40 + c + r / 2);
}

const std::string kXmp =
    "<x:xmpmeta><rdf:RDF><rdf:Description xmlns:apdi=\"http://ns.apple.com/pixeldatainfo/1.0/\">"
    "<apdi:FloatMinValue>0.4</apdi:FloatMinValue><apdi:FloatMaxValue>2.5</apdi:FloatMaxValue>"
    "</rdf:Description></rdf:RDF></x:xmpmeta>";

class HeifPhoto : public testing::Test {
 protected:
  static std::string make(const test::HeicLayout& how) {
    static const test::HevcPicture color =
        test::hevcPicture([](int k, int c, int, int) { return static_cast<std::uint32_t>(k == 0 ? 2 * c : 128); });
    static const test::HevcPicture depth =
        test::hevcPicture([](int k, int c, int r, int) { return k == 0 ? disparityCode(c, r) : 128u; });
    return test::heicFile(color, depth, how);
  }
  test::OpenedFilm photo(const test::HeicLayout& how) {
    const std::string path = folder_ / "a.heic";
    std::ofstream(path, std::ios::binary) << make(how);
    return test::openFilm({.url = path});
  }
  test::TemporaryFolder folder_;
};

double millimetresAt(int c, int r) {
  return 1000 / (kLeast + (kMost - kLeast) * disparityCode(c, r) / 255);
}

TEST_F(HeifPhoto, DisparityIsDepthBesideTheColour) {
  const test::OpenedFilm film = photo({.xmp = kXmp});
  ASSERT_TRUE(film.info.has_depth);
  EXPECT_EQ(film.info.frame_period, Duration(0)) << "a photo";
  EXPECT_NEAR(film.info.calibration.calibration.near_mm, 400, 0.01);
  EXPECT_NEAR(film.info.calibration.calibration.far_mm, 2500, 0.01);
  EXPECT_EQ(film.info.color_width, kCols);
  EXPECT_NEAR(test::sampleAt(film.pair.color, 1, 60, 30), 120, 8);
  for (int c = 3; c < kCols; c += 9) {
    ASSERT_NEAR(film.distanceAt(c, 30), millimetresAt(c, 30), 0.012 * millimetresAt(c, 30)) << c;
  }
}

// An iPhone's photos of 24 megapixels are larger than a film's pictures may be.
TEST_F(HeifPhoto, ALargePhotoIsHalved) {
  constexpr int kWide = 5120, kHigh = 3328;  // 17 million samples
  const auto color = [](int k, int c, int r, int) {
    return k == 0 ? static_cast<std::uint32_t>(c / 32 + r / 64) : 128u;
  };
  const auto depth = [](int k, int c, int r, int) { return k == 0 ? disparityCode(c, r) : 128u; };
  const std::string path = folder_ / "a.heic";
  std::ofstream(path, std::ios::binary) << test::heicFile(test::hevcPicture(color, kWide, kHigh),
                                                          test::hevcPicture(depth), {.xmp = kXmp});
  const test::OpenedFilm film = test::openFilm({.url = path});
  ASSERT_TRUE(film.info.has_depth);
  EXPECT_EQ(film.info.color_width, kWide / 2);
  EXPECT_EQ(film.pair.color.height, kHigh / 2);
  EXPECT_NEAR(test::sampleAt(film.pair.color, 1, 2400, 1600), 4800 / 32 + 3200 / 64, 2);
  EXPECT_THAT(film.info.notes, testing::Contains(testing::HasSubstr("a photo of 5120 x 3328")));
  EXPECT_NEAR(film.distanceAt(60, 30), millimetresAt(60, 30), 0.012 * millimetresAt(60, 30));
}

TEST_F(HeifPhoto, BothPicturesComeUpright) {
  const test::OpenedFilm film = photo({.quarter_turns = 3, .xmp = kXmp});  // 270 degrees anticlockwise: 90 clockwise
  ASSERT_TRUE(film.info.has_depth);
  ASSERT_EQ(film.info.color_width, kRows);
  ASSERT_EQ(film.info.depth_width, kRows);
  ASSERT_EQ(film.info.depth_height, kCols);
  // Column c and row r of the file are at column rows - 1 - r and row c.
  EXPECT_NEAR(film.distanceAt(kRows - 1 - 10, 70), millimetresAt(70, 10), 0.012 * millimetresAt(70, 10));
  EXPECT_NEAR(test::sampleAt(film.pair.color, 1, 20, 60), 120, 8);
}

TEST_F(HeifPhoto, WithoutARangeItIsStillDisparity) {
  const test::OpenedFilm film = photo({});
  ASSERT_TRUE(film.info.has_depth);
  EXPECT_EQ(film.info.calibration.calibration.law, DepthLaw::Inverse);
  EXPECT_EQ(film.info.calibration.calibration.polarity, DepthPolarity::NearIsHigh);
  EXPECT_GT(film.heightAt(90, 30), film.heightAt(10, 30));
}

TEST_F(HeifPhoto, TheTwoPicturesOfAStereoPairAreViews) {
  // Item 2 is darker in the middle; the group says which one is the left.
  for (const bool second_left : {false, true}) {
    const std::string pair = test::heicGroup("ster", second_left ? std::vector{2u, 1u} : std::vector{1u, 2u});
    const test::OpenedFilm film =
        photo({.auxiliary = false, .groups = test::heicBox("grpl", test::heicGroup("altr", {7, 8}) + pair)});
    EXPECT_EQ(film.info.packing, Packing::StereoTracks);
    EXPECT_FALSE(film.info.has_depth);
    ASSERT_FALSE(film.pair.right.empty());
    const Frame &first = second_left ? film.pair.right : film.pair.color,
                &second = second_left ? film.pair.color : film.pair.right;
    EXPECT_NEAR(test::sampleAt(first, 1, 90, 30), 180, 8);
    EXPECT_NEAR(test::sampleAt(second, 1, 90, 30), disparityCode(90, 30), 8);
  }
}

TEST_F(HeifPhoto, DamagedGroupsAreNoViews) {
  const auto views = [&](const std::string& groups) {
    const std::string file = make({.auxiliary = false, .groups = groups});
    return kHeif.parts(std::make_shared<const std::vector<std::uint8_t>>(file.begin(), file.end())).size();
  };
  EXPECT_EQ(views(test::heicBox("grpl", test::heicGroup("ster", {1, 2}))), 2u);
  for (const std::string& groups :
       {std::string(), test::heicBox("grpl", test::heicGroup("ster", {1, 2, 3})), test::heicBox("grpl", ""),
        test::heicBox("grpl", test::heicBox("ster", "")), test::heicBox("grpl", test::heicGroup("altr", {1, 2})),
        test::heicBox("grpl", "\xff\xff\xff\xffster" + std::string(24, '\1'))}) {
    EXPECT_EQ(views(groups), 0u);
  }
}

}  // namespace
}  // namespace relievo
