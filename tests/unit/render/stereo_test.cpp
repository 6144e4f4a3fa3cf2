// SPDX-License-Identifier: Apache-2.0
// The stereo cameras against similar triangles worked out on paper.
#include "app/render/relief/stereo.h"

#include <gtest/gtest.h>

#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};
constexpr int kWidth = 1280, kHeight = 720;

struct Ndc {
  double x, y, depth;
};

Ndc project(const EyeView& view, double x, double y, double z) {
  const glm::dvec4 clip = view.view_projection * glm::dvec4(x, y, z, 1.0);
  return {clip.x / clip.w, clip.y / clip.w, clip.z / clip.w};
}

// On a window of 160 mm, one unit of normalised device coordinates is 80 mm in the screen plane.
double disparityMm(const EyeViews& eyes, double x, double y, double z) {
  return 80.0 * (project(eyes.views[0], x, y, z).x - project(eyes.views[1], x, y, z).x);
}

TEST(Stereo, PointInFrontOfTheScreenIsCrossedByEyesTimesHeightOverDistance) {
  // e = 63, d = 600, screen at 20: z = 40 is h = 20 in front, 63 * 20 / 580 = 2.172414 mm; z = 0 is 20 behind,
  // 63 * -20 / 620 = -2.032258 mm.
  const EyeViews eyes = eyeViews({}, kVolume, kWidth, kHeight);
  EXPECT_NEAR(disparityMm(eyes, 0, 0, 40), 2.172414, 1e-6);
  EXPECT_NEAR(disparityMm(eyes, 0, 0, 0), -2.032258, 1e-6);
  EXPECT_NEAR(disparityMm(eyes, 0, 0, 20), 0.0, 1e-9);
}

TEST(Stereo, DisparityDependsOnDepthAlone) {
  const EyeViews eyes = eyeViews({}, kVolume, kWidth, kHeight);
  EXPECT_NEAR(disparityMm(eyes, 71, -33, 40), 2.172414, 1e-6);
  EXPECT_NEAR(disparityMm(eyes, -71, 40, 40), 2.172414, 1e-6);
}

TEST(Stereo, ThereIsNoVerticalParallax) {
  const EyeViews eyes = eyeViews({}, kVolume, kWidth, kHeight);
  for (const double z : {0.0, 13.0, 40.0}) {
    for (const double y : {-44.0, 10.0, 44.0}) {
      EXPECT_NEAR(project(eyes.views[0], 60, y, z).y, project(eyes.views[1], 60, y, z).y, 1e-12);
    }
  }
}

TEST(Stereo, EachEyeSeesAPointWhereItsRayMeetsTheScreen) {
  // Left eye at (-31.5, 0, 620). The ray to (50, 30, 40) meets z = 20 at
  // x = -31.5 + 81.5 * 600/580 = 52.810345, y = 30 * 600/580 = 31.034483.
  const EyeViews eyes = eyeViews({}, kVolume, kWidth, kHeight);
  const Ndc left = project(eyes.views[0], 50, 30, 40);
  EXPECT_NEAR(80.0 * left.x, 52.810345, 1e-6);
  EXPECT_NEAR(45.0 * left.y, 31.034483, 1e-6);
}

TEST(Stereo, PictureInTheScreenPlaneFillsItsWindowForEveryEye) {
  for (const StereoLayout layout : {StereoLayout::Mono, StereoLayout::SideBySide, StereoLayout::Anaglyph}) {
    const EyeViews eyes = eyeViews({.layout = layout}, kVolume, kWidth, kHeight);
    for (const EyeView& view : eyes.views) {
      const Ndc corner = project(view, 80, 45, 20);
      EXPECT_NEAR(corner.x, 1.0, 1e-9);
      EXPECT_NEAR(corner.y, 1.0, 1e-9);
    }
  }
}

TEST(Stereo, NearerPointsAreNearerInDepth) {
  const EyeViews eyes = eyeViews({}, kVolume, kWidth, kHeight);
  const double low = project(eyes.views[0], 0, 0, 0).depth;
  const double high = project(eyes.views[0], 0, 0, 40).depth;
  EXPECT_LT(high, low);
  // A force arrow of 10 N is 50 mm long, and the finger may stand at the top or at the bottom of the volume.
  EXPECT_LT(project(eyes.views[0], 0, 0, -60).depth, 1.0);
  EXPECT_GT(project(eyes.views[0], 0, 0, 100).depth, -1.0);
}

TEST(Stereo, WideSurfaceHasBarsAtTheSidesAndNarrowOneAboveAndBelow) {
  // 160 x 90 on a surface of 32:9 takes the middle half of its width; on 8:9, the middle half of its height.
  const EyeView wide = eyeViews({.layout = StereoLayout::Mono}, kVolume, 1280, 360).views[0];
  EXPECT_NEAR(project(wide, 80, 45, 20).x, 0.5, 1e-9);
  EXPECT_NEAR(project(wide, 80, 45, 20).y, 1.0, 1e-9);
  const EyeView narrow = eyeViews({.layout = StereoLayout::Mono}, kVolume, 640, 720).views[0];
  EXPECT_NEAR(project(narrow, 80, 45, 20).x, 1.0, 1e-9);
  EXPECT_NEAR(project(narrow, 80, 45, 20).y, 0.5, 1e-9);
}

std::vector<PixelArea> areas(const StereoSettings& settings, int width, int height) {
  std::vector<PixelArea> result;
  for (const EyeView& view : eyeViews(settings, kVolume, width, height).views) result.push_back(view.area);
  return result;
}

TEST(Stereo, EachLayoutGivesEachEyeItsPart) {
  using enum StereoLayout;
  using Areas = std::vector<PixelArea>;
  EXPECT_EQ(areas({.layout = Mono}, 1280, 720), (Areas{{0, 0, 1280, 720}}));
  EXPECT_EQ(areas({.layout = SideBySide}, 1281, 720), (Areas{{0, 0, 640, 720}, {640, 0, 641, 720}}));
  EXPECT_EQ(areas({.layout = TopBottom}, 1280, 721), (Areas{{0, 360, 1280, 361}, {0, 0, 1280, 360}}));
  // 1080 lines, 45 of blanking, 1080 lines; 720, 30, 720.
  EXPECT_EQ(areas({.layout = FramePacking}, 1920, 2205), (Areas{{0, 1125, 1920, 1080}, {0, 0, 1920, 1080}}));
  EXPECT_EQ(areas({.layout = FramePacking}, 1280, 1470), (Areas{{0, 750, 1280, 720}, {0, 0, 1280, 720}}));
  EXPECT_EQ(areas({.layout = FramePacking}, 3840, 1080), (Areas{{0, 0, 1920, 1080}, {1920, 0, 1920, 1080}}));
  EXPECT_EQ(areas({.layout = FramePacking}, 2560, 720), (Areas{{0, 0, 1280, 720}, {1280, 0, 1280, 720}}));
  for (const StereoLayout mixed : {Rows, Columns, Anaglyph}) {
    EXPECT_EQ(areas({.layout = mixed}, 1280, 720), (Areas{{0, 0, 1280, 720}, {0, 0, 1280, 720}}));
    EXPECT_TRUE(eyeViews({.layout = mixed}, kVolume, 1280, 720).mixed);
  }
  EXPECT_EQ(areas({.layout = Quilt, .quilt_cols = 2, .quilt_rows = 2}, 640, 360),
            (Areas{{0, 0, 320, 180}, {320, 0, 320, 180}, {0, 180, 320, 180}, {320, 180, 320, 180}}));
}

TEST(Stereo, LeftEyeSeesANearPointFurtherToTheRight) {
  for (int i = 1; i < kStereoLayouts; ++i) {
    const auto layout = static_cast<StereoLayout>(i);
    const EyeViews eyes = eyeViews({.layout = layout}, kVolume, kWidth, kHeight);
    EXPECT_GT(project(eyes.views.front(), 0, 0, 40).x, project(eyes.views.back(), 0, 0, 40).x) << name(layout);
  }
}

TEST(Stereo, ViewsOfAQuiltStandEvenlyFromLeftToRight) {
  const EyeViews eyes = eyeViews({.layout = StereoLayout::Quilt, .quilt_cols = 5, .quilt_rows = 1}, kVolume, 800, 90);
  // Four eyes' distances from the first to the last.
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(eyes.views[i].eye_x_mm, -126.0 + 63.0 * static_cast<double>(i), 1e-9);
}

TEST(Stereo, SwappedEyesTurnAQuiltRoundAsWell) {
  const StereoSettings swapped{.layout = StereoLayout::Quilt, .quilt_cols = 5, .quilt_rows = 1, .swap_eyes = true};
  const EyeViews eyes = eyeViews(swapped, kVolume, 800, 90);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(eyes.views[i].eye_x_mm, 126.0 - 63.0 * static_cast<double>(i), 1e-9);
}

TEST(Stereo, HalvesAreSqueezedAndFullOnesAreNot) {
  // 160 x 90 on 1280 x 360: two halves of 640 x 360 fit it as they are; squeezed, each is to look 32:9 wide.
  const StereoSettings full{.layout = StereoLayout::SideBySide, .full = true};
  EXPECT_NEAR(project(eyeViews(full, kVolume, 1280, 360).views[0], 80, 45, 20).x, 1.0, 1e-9);
  const StereoSettings half{.layout = StereoLayout::SideBySide};
  EXPECT_NEAR(project(eyeViews(half, kVolume, 1280, 360).views[0], 80, 45, 20).x, 0.5, 1e-9);
  const StereoSettings above{.layout = StereoLayout::TopBottom, .full = true};
  EXPECT_NEAR(project(eyeViews(above, kVolume, 640, 720).views[0], 80, 45, 20).y, 1.0, 1e-9);
  EXPECT_NEAR(project(eyeViews({.layout = StereoLayout::FramePacking}, kVolume, 1280, 1470).views[0], 80, 45, 20).y,
              1.0, 1e-9);
}

TEST(Stereo, RefusesWhatTheSurfaceCannotShowAndSaysWhatWould) {
  const StereoSettings packed{.layout = StereoLayout::FramePacking};
  EXPECT_EQ(refusal(packed, 1920, 2205), nullptr);
  EXPECT_EQ(refusal(packed, 1280, 1470), nullptr);
  ASSERT_NE(refusal(packed, 1920, 1080), nullptr);
  EXPECT_NE(std::string(refusal(packed, 1920, 1080)).find("1920x2205"), std::string::npos);
  EXPECT_NE(refusal({.layout = StereoLayout::Quilt}, 100, 720), nullptr);
  EXPECT_EQ(refusal({.layout = StereoLayout::Quilt}, 1280, 720), nullptr);
  EXPECT_NE(refusal({.layout = StereoLayout::Quilt}, 1280, 90), nullptr) << "rows of 15 pixels";
  EXPECT_NE(refusal({.layout = StereoLayout::Quilt, .quilt_cols = 8, .quilt_rows = 0}, 1280, 720), nullptr);
  EXPECT_NE(refusal({.layout = StereoLayout::Rows}, 1, 1), nullptr);
  EXPECT_EQ(refusal({.layout = StereoLayout::Mono}, 1, 1), nullptr);
}

TEST(Stereo, StrengthIsAFactorOfTheDisparity) {
  EXPECT_NEAR(disparityMm(eyeViews({.strength = 0.5}, kVolume, kWidth, kHeight), 0, 0, 40), 0.5 * 2.172414, 1e-6);
  EXPECT_NEAR(disparityMm(eyeViews({.strength = 0}, kVolume, kWidth, kHeight), 0, 0, 40), 0.0, 1e-9);
}

TEST(Stereo, HeightOfAPixelShiftsTheNearestPointByOne) {
  // At h = 20: 8 pixels a mm, e d / (d - h)^2 = 63 * 600 / 580^2 = 0.112366 mm of shift a mm: 1.1124 mm of height.
  EXPECT_NEAR(heightOfPixelMm({}, kVolume, 8.0), 1.112434, 1e-5);
  EXPECT_NEAR(heightOfPixelMm({.strength = -3}, kVolume, 8.0), 1.112434 / 3, 1e-5) << "deeper, and turned inside out";
  // A box that reaches behind the eyes: a tenth of the way is as near as anything is drawn.
  EXPECT_NEAR(heightOfPixelMm({}, {160, 90, 900}, 8.0), 60.0 * 60 / (63 * 600 * 8), 1e-5);
}

TEST(Stereo, SwappedEyesTurnTheDisparityRound) {
  const EyeViews eyes = eyeViews({.swap_eyes = true}, kVolume, kWidth, kHeight);
  EXPECT_NEAR(disparityMm(eyes, 0, 0, 40), -2.172414, 1e-6);
}

TEST(Stereo, MonoSeesFromBetweenTheEyes) {
  const EyeViews mono = eyeViews({.layout = StereoLayout::Mono}, kVolume, kWidth, kHeight);
  ASSERT_EQ(mono.views.size(), 1U);
  EXPECT_NEAR(project(mono.views[0], 0, 0, 40).x, 0.0, 1e-12);
}

TEST(Stereo, EyesInOnePlaceSeeTheSame) {
  const EyeViews eyes = eyeViews({.eye_distance_mm = 0}, kVolume, kWidth, kHeight);
  EXPECT_NEAR(disparityMm(eyes, 30, 20, 40), 0.0, 1e-12);
}

}  // namespace
}  // namespace relievo
