// SPDX-License-Identifier: Apache-2.0
// Subtitles in depth: never behind, never jumping, on scenes whose disparities are known on paper.
#include "app/render/relief/words_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace relievo {
namespace {

// A picture 160 mm wide on 1280 pixels: 8 px a mm. The screen plane lies at 20 mm of 40.
constexpr double kWidthPx = 1280, kPixelsPerMm = 8;
constexpr double kInFrontPx = WordsPlace::kInFront * kWidthPx;
const StereoSettings kStereo{.layout = StereoLayout::SideBySide, .screen_z_mm = 20};
constexpr WordsBox kBox{-40, -40, 40, -30};  // at the foot, in the middle

// e h / (d - h) in pixels.
double disparityOf(double z_mm) {
  const double h = z_mm - kStereo.screen_z_mm;
  return kPixelsPerMm * kStereo.eye_distance_mm * h / (kStereo.viewing_distance_mm - h);
}

struct Relief {
  std::vector<TexturedVertex> vertices;
  std::vector<std::uint32_t> indices;

  // A rectangle as two triangles.
  void add(double left, double bottom, double right, double top, double z) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const double y : {bottom, top}) {
      for (const double x : {left, right}) {
        vertices.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0, 0});
      }
    }
    for (const std::uint32_t k : {0u, 1u, 3u, 0u, 3u, 2u}) indices.push_back(first + k);
  }
  void follow(WordsPlace& words, const StereoSettings& stereo = kStereo) const {
    words.follow(vertices, indices, kBox, stereo, kWidthPx, kPixelsPerMm);
  }
};

Relief wallAt(double z_mm) {
  Relief relief;
  relief.add(-80, -45, 80, 45, z_mm);
  return relief;
}

TEST(WordsPlace, StandsJustInFrontOfAWall) {
  for (const double z : {0.0, 20.0, 35.0}) {
    WordsPlace words;
    wallAt(z).follow(words);
    EXPECT_NEAR(words.behind(), disparityOf(z), 1e-3);
    EXPECT_NEAR(words.disparity(), disparityOf(z) + kInFrontPx, 1e-3);
  }
}

TEST(WordsPlace, ThePartOfEachEyeIsHalfTheDisparity) {
  WordsPlace words;
  wallAt(35).follow(words);
  const double left = words.shiftPx(-31.5, kStereo), right = words.shiftPx(31.5, kStereo);
  EXPECT_NEAR(left - right, words.disparity(), 1e-9);
  EXPECT_GT(left, 0) << "in front of the screen the left eye sees a thing farther right";
  EXPECT_NEAR(left, -right, 1e-9);
}

TEST(WordsPlace, OnlyWhatIsUnderOrNearTheBoxCounts) {
  Relief relief = wallAt(0);
  relief.add(-80, 20, 80, 45, 40);  // far above the words
  WordsPlace words;
  relief.follow(words);
  EXPECT_LT(words.disparity(), disparityOf(40) - 5);
  EXPECT_GE(words.disparity(), words.behind());
}

// A block comes from the left at the fastest speed that is foreseen, passes under the words and goes away.
TEST(WordsPlace, IsLiftedInTimeByWhatComesFromTheSide) {
  WordsPlace words;
  const double step_mm = WordsPlace::kFastestBlind * kWidthPx / kPixelsPerMm;
  double last = 0, highest = -100;
  for (int k = 0; k < 160; ++k) {
    Relief relief = wallAt(0);
    const double left = -120 + step_mm * k;
    relief.add(left, -45, left + 30, 45, 40);
    relief.follow(words);
    EXPECT_GE(words.disparity(), words.behind()) << "picture " << k;
    if (k > 0) {
      EXPECT_LE(words.disparity() - last, WordsPlace::kStep + 1e-9) << "picture " << k;
      EXPECT_GE(words.disparity() - last, -WordsPlace::kStep - 1e-9) << "picture " << k;
    }
    last = words.disparity();
    highest = std::max(highest, last);
  }
  EXPECT_EQ(words.lifted(), 0u);
  EXPECT_GE(highest, disparityOf(40));
  EXPECT_LT(last, highest - 10) << "it sinks again";
}

// A film whose next pictures are known. `fill` gives the codes of a picture, 0 to 255 for 0 to 40 mm.
class KnownAhead : public testing::Test {
 protected:
  static constexpr int kCols = 160, kRows = 90;
  using Fill = std::function<std::uint8_t(int picture, double x_mm)>;

  struct Moved {
    double most_up = 0, most_down = 0, nearest_gap = 1e9, highest = -1e9, last = 0;
    std::uint64_t lifted = 0;
  };
  static Moved play(int pictures, std::size_t ahead, const Fill& fill) {
    const DisplayVolume volume = DisplayVolume::forPicture(kCols, kRows);
    const GridMapping grid(volume, kCols, kRows);
    const auto codeAt = [&](int picture, int c) { return fill(picture, grid.x(c)); };
    std::vector<CoarseRelief> coarse;
    for (int k = 0; k < pictures; ++k) coarse.push_back(coarseOf(k, volume, codeAt));
    Moved moved;
    WordsPlace words;
    for (int k = 0; k < pictures; ++k) {
      Relief relief;  // a strip for each column, exactly as high as its samples
      for (int c = 0; c < kCols; ++c) {
        relief.add(grid.x(c - 0.5), -45, grid.x(c + 0.5), 45, 40.0 * codeAt(k, c) / 255);
      }
      ReliefAhead coming{.more = k + static_cast<int>(ahead) + 1 < pictures};
      for (std::size_t i = 1; i <= ahead && static_cast<std::size_t>(k) + i < coarse.size(); ++i) {
        coming.coming[coming.count++] = {static_cast<int>(i), &coarse[static_cast<std::size_t>(k) + i]};
      }
      words.follow(relief.vertices, relief.indices, kBox, kStereo, kWidthPx, kPixelsPerMm, coming);
      if (k > 0) moved.most_up = std::max(moved.most_up, words.disparity() - moved.last);
      if (k > 0) moved.most_down = std::max(moved.most_down, moved.last - words.disparity());
      moved.last = words.disparity();
      moved.highest = std::max(moved.highest, moved.last);
      moved.nearest_gap = std::min(moved.nearest_gap, words.disparity() - words.behind());
    }
    moved.lifted = words.lifted();
    return moved;
  }

 private:
  template <class CodeAt>
  static CoarseRelief coarseOf(int picture, const DisplayVolume& volume, const CodeAt& codeAt) {
    std::vector<std::uint8_t> codes;
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kCols; ++c) codes.push_back(codeAt(picture, c));
    }
    Frame frame;
    frame.width = kCols, frame.height = kRows;
    frame.range = ColorRange::Full;
    frame.planes[0] = {codes.data(), kCols};
    frame.plane_count = 1;
    return CoarseRelief::of(HeightField::make(frame, DepthCalibration{}, volume).value());
  }
};

// A block comes from outside the picture and crosses it in ten pictures or more, 8 px of disparity before a wall.
TEST_F(KnownAhead, FastEdgesLiftByAStepAPictureAtMost) {
  const double near = disparityOf(40);
  for (const double share : {1.0 / 40, 1.0 / 20, 1.0 / 10}) {
    const auto moved = play(160, ReliefAhead::kMost, [&](int k, double x) -> std::uint8_t {
      const double left = -200 + share * 160 * k;  // seen from x = -80 on
      return x >= left && x < left + 60 ? std::uint8_t{255} : std::uint8_t{200};
    });
    EXPECT_LE(moved.most_up, WordsPlace::kStep + 1e-6) << share;
    EXPECT_LE(moved.most_down, WordsPlace::kSink + 1e-9) << share;
    EXPECT_GE(moved.nearest_gap, -1e-9) << share;
    EXPECT_GE(moved.highest, near) << share;
    EXPECT_EQ(moved.lifted, 0u) << share;
  }
}

// A block rests at the picture's border, 34 px before a wall, and then darts below the words.
TEST_F(KnownAhead, WhatDartsFromTheBorderIsMetWithoutAJump) {
  const auto moved = play(80, ReliefAhead::kMost, [](int k, double x) -> std::uint8_t {
    const double left = k < 40 ? -80 : -80 + 160.0 / 6 * (k - 40);
    return x >= left && x < left + 20 ? std::uint8_t{255} : std::uint8_t{0};
  });
  EXPECT_LE(moved.most_up, WordsPlace::kStep + 1e-6);
  EXPECT_GE(moved.nearest_gap, -1e-9);
  EXPECT_GE(moved.highest, disparityOf(40));
  EXPECT_EQ(moved.lifted, 0u);
}

// Something rises under the words from one picture to the next. The pictures that are known ahead leave enough steps to
// lift the words.
TEST_F(KnownAhead, ARiseOfNineStepsIsMetInTime) {
  const std::uint8_t low = 160, high = 222;
  ASSERT_NEAR(disparityOf(40.0 * high / 255) - disparityOf(40.0 * low / 255), 8.5, 0.4);
  const auto moved = play(40, ReliefAhead::kMost, [&](int k, double) { return k < 20 ? low : high; });
  EXPECT_LE(moved.most_up, WordsPlace::kStep + 1e-6);
  EXPECT_GE(moved.nearest_gap, -1e-9);
  EXPECT_EQ(moved.lifted, 0u);
}

// 34 px at once, known 8 pictures before: nine equal steps of under 4 px, instead of one of 31.
TEST_F(KnownAhead, AHugeRiseIsMetInEqualSteps) {
  const auto wall = [](int k, double) { return k < 20 ? std::uint8_t{0} : std::uint8_t{255}; };
  const auto moved = play(40, ReliefAhead::kMost, wall);
  const double rise = disparityOf(40) - disparityOf(0);
  EXPECT_GE(moved.nearest_gap, -1e-3);
  EXPECT_LE(moved.most_up, rise / 9 + 1e-3);
  EXPECT_GE(moved.most_up, (rise - kInFrontPx) / 9 - 1e-3);
  EXPECT_LE(moved.lifted, 9u);
  EXPECT_NEAR(play(40, 0, wall).most_up, rise - kInFrontPx, 1e-3) << "nothing known";
}

// 34 px at once as well, but the words appear only three pictures before.
TEST_F(KnownAhead, WordsThatAppearShortlyBeforeAHugeRiseAppearNearIt) {
  const auto moved =
      play(20, ReliefAhead::kMost, [](int k, double) { return k < 3 ? std::uint8_t{0} : std::uint8_t{255}; });
  EXPECT_LE(moved.most_up, WordsPlace::kStep + 1e-6);
  EXPECT_GE(moved.nearest_gap, -1e-9);
  EXPECT_EQ(moved.lifted, 0u);
}

// What comes after a cut does not count: the words are placed anew there.
TEST_F(KnownAhead, WhatComesBehindACutDoesNotCount) {
  WordsPlace words;
  ReliefAhead coming{.more = false};
  Relief relief = wallAt(0);
  relief.add(50, -45, 80, 45, 40);  // beside the words
  words.follow(relief.vertices, relief.indices, kBox, kStereo, kWidthPx, kPixelsPerMm, coming);
  EXPECT_NEAR(words.disparity(), disparityOf(0) + kInFrontPx, 1e-3);
  words.begin();
  coming.more = true;
  words.follow(relief.vertices, relief.indices, kBox, kStereo, kWidthPx, kPixelsPerMm, coming);
  EXPECT_GT(words.disparity(), disparityOf(0) + kInFrontPx + 5);
}

TEST(WordsPlace, NeverStandsBehindEvenIfItMustJump) {
  WordsPlace words;
  wallAt(0).follow(words);
  wallAt(40).follow(words);
  EXPECT_GE(words.disparity(), words.behind());
  EXPECT_EQ(words.lifted(), 1u);
}

TEST(WordsPlace, AReliefThatReachesTheEyesIsNearerThanAnyOther) {
  for (const double z : {kStereo.screen_z_mm + kStereo.viewing_distance_mm, 700.0}) {
    WordsPlace words;
    wallAt(z).follow(words);
    EXPECT_GT(words.disparity(), disparityOf(500)) << z;
    EXPECT_TRUE(std::isfinite(words.disparity())) << z;
  }
}

TEST(WordsPlace, OtherWordsStandAtTheirPlaceAtOnce) {
  WordsPlace words;
  wallAt(40).follow(words);
  words.begin();
  wallAt(0).follow(words);
  EXPECT_NEAR(words.disparity(), disparityOf(0) + kInFrontPx, 1e-3);
  EXPECT_EQ(words.lifted(), 0u);
}

TEST(WordsPlace, WithoutEyesThereIsNoShift) {
  StereoSettings flat = kStereo;
  flat.strength = 0;
  WordsPlace words;
  wallAt(40).follow(words, flat);
  EXPECT_EQ(words.shiftPx(0, flat), 0);
}

}  // namespace
}  // namespace relievo
