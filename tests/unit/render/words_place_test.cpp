// SPDX-License-Identifier: Apache-2.0
// Subtitles in depth: never behind, never jumping, on scenes whose disparities are known on paper.
#include "app/render/relief/words_place.h"

#include <gtest/gtest.h>

#include <cmath>
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
  const double step_mm = WordsPlace::kFastest * kWidthPx / kPixelsPerMm;
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

TEST(WordsPlace, NeverStandsBehindEvenIfItMustJump) {
  WordsPlace words;
  wallAt(0).follow(words);
  wallAt(40).follow(words);
  EXPECT_GE(words.disparity(), words.behind());
  EXPECT_EQ(words.lifted(), 1u);
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
