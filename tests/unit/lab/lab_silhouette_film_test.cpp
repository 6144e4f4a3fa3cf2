// SPDX-License-Identifier: Apache-2.0
// The film of silhouettes: its frames and what eyes see of it, against each other and against similar triangles.
#include "app/lab/detail/silhouette_film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "app/scene/display_volume.h"

namespace relievo {
namespace {

constexpr int kCols = SilhouetteFilm::kCols, kRows = SilhouetteFilm::kRows;
constexpr DisplayVolume kVolume = DisplayVolume::forPicture(kCols, kRows);

int channel(const DrawnPicture& picture, int x, int y, int c) {
  return picture.rgba[(static_cast<std::size_t>(y) * picture.width + x) * 4 + c];
}

// Only the ball is this red.
bool isBall(const DrawnPicture& picture, int x, int y) {
  return channel(picture, x, y, 0) > 2 * channel(picture, x, y, 2);
}

TEST(SilhouetteFilm, FromVeryFarTheEyesSeeTheFrameOfColour) {
  const Frame color = SilhouetteFilm::color(9);
  const EyeViews eyes = eyeViews({.layout = StereoLayout::Mono, .viewing_distance_mm = 1e7}, kVolume, kCols, kRows);
  const DrawnPicture seen = SilhouetteFilm::seen(9, eyes, kCols, kRows, 1);
  int different = 0;
  for (int y = 0; y < kRows; ++y) {
    const std::uint8_t* row = color.planes[0].data + y * color.planes[0].stride_bytes;
    for (int x = 0; x < kCols; ++x) {
      for (int c = 0; c < 3; ++c) different += std::abs(row[3 * x + c] - channel(seen, x, y, c)) > 1 ? 1 : 0;
    }
  }
  EXPECT_LT(different, 20);  // of a million: samples that lie on a rim
}

// The ball of the first frame: its rim, 11.52 mm around (-52, -26), is 27.36 mm high, 7.36 before the screen plane. The
// left eye stands at -31.5 and 600 from that: what is at x appears at -31.5 + (x + 31.5) 600/592.64. Its half is 640
// pixels wide and shows 720/486 of 16:9 in the middle.
TEST(SilhouetteFilm, EachEyeSeesAThingWhereSimilarTrianglesPutIt) {
  const EyeViews eyes = eyeViews({.layout = StereoLayout::SideBySide}, kVolume, 1280, 720);
  const DrawnPicture seen = SilhouetteFilm::seen(0, eyes, 1280, 720, 1);
  const double grow = 600 / 592.64;
  const int row = static_cast<int>((54 + 26 * grow) * 720 / 108);
  for (const int eye : {0, 1}) {
    const double eye_x = eye == 0 ? -31.5 : 31.5;
    int first = 640 * eye;
    while (first < 640 * (eye + 1) && !isBall(seen, first, row)) ++first;
    int last = first;
    while (isBall(seen, last + 1, row)) ++last;
    const auto pixel = [&](double x) { return 640 * eye + 320 + (eye_x + (x - eye_x) * grow) * 720 / 108 / 2; };
    EXPECT_NEAR(first, pixel(-52 - 11.52), 1) << eye;
    EXPECT_NEAR(last + 1, pixel(-52 + 11.52), 1) << eye;
  }
}

TEST(SilhouetteFilm, MarksAreRedNearAJumpWhiteElsewhereAndBlackAtTheRim) {
  Frame depth = SilhouetteFilm::depth(0);
  const auto samples = std::make_shared<std::vector<std::uint8_t>>(std::size_t{kCols} * kRows, 100);
  for (int r = 200; r < kRows; ++r) {
    for (int c = 300; c < kCols; ++c) (*samples)[static_cast<std::size_t>(r) * kCols + c] = 107;  // by 1.1 mm
  }
  (*samples)[std::size_t{100} * kCols + 500] = 106;  // by 0.94 mm
  depth.planes[0].data = samples->data();
  depth.owner = samples;
  const Frame marks = SilhouetteFilm::marks(depth, 3);
  const auto color = [&](int c, int r) {
    const std::uint8_t* at = marks.planes[0].data + r * marks.planes[0].stride_bytes + 3 * c;
    EXPECT_EQ(at[1], at[2]);
    return std::pair<int, int>(at[0], at[1]);
  };
  const std::pair white{255, 255}, red{255, 0}, black{0, 0};
  EXPECT_EQ(color(295, 300), white);
  EXPECT_EQ(color(296, 300), red);  // 299, left of the jump, less 3
  EXPECT_EQ(color(303, 300), red);
  EXPECT_EQ(color(304, 300), white);
  EXPECT_EQ(color(400, 195), white);
  EXPECT_EQ(color(400, 196), red);
  EXPECT_EQ(color(400, 203), red);
  EXPECT_EQ(color(400, 204), white);
  EXPECT_EQ(color(500, 100), white);
  EXPECT_EQ(color(1, 100), black);
  EXPECT_EQ(color(2, 100), white);
  EXPECT_EQ(color(100, kRows - 2), black);
  EXPECT_EQ(color(100, kRows - 3), white);
}

TEST(SilhouetteFilm, HasSilhouettesAndFillsTheVolume) {
  for (const int index : {0, 20, 40}) {
    const Frame depth = SilhouetteFilm::depth(index);
    const std::size_t size = std::size_t{kCols} * kRows;
    const auto [low, high] = std::minmax_element(depth.planes[0].data, depth.planes[0].data + size);
    EXPECT_LT(*low, 30) << index;
    EXPECT_GT(*high, 220) << index;
    EXPECT_LT(*high, 255) << index;  // nothing is cut off at the front
    const Frame marks = SilhouetteFilm::marks(depth, 0);
    std::size_t red = 0;
    for (std::size_t i = 0; i < size; ++i) red += marks.planes[0].data[3 * i + 1] == 0 ? 1 : 0;
    EXPECT_GT(red, size / 200) << index;
    EXPECT_LT(red, size / 20) << index;
  }
}

}  // namespace
}  // namespace relievo
