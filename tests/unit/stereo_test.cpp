// SPDX-License-Identifier: Apache-2.0
// The stereo cameras against similar triangles worked out on paper.
#include "app/render/stereo.h"

#include <gtest/gtest.h>

#include <glm/vec4.hpp>

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
    for (int i = 0; i < eyes.count; ++i) {
      const Ndc corner = project(eyes.views[static_cast<std::size_t>(i)], 80, 45, 20);
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

TEST(Stereo, SideBySideGivesTheLeftHalfToTheLeftEye) {
  const EyeViews eyes = eyeViews({.layout = StereoLayout::SideBySide}, kVolume, kWidth, kHeight);
  ASSERT_EQ(eyes.count, 2);
  EXPECT_EQ(eyes.views[0].x, 0.0);
  EXPECT_EQ(eyes.views[0].width, 0.5);
  EXPECT_EQ(eyes.views[1].x, 0.5);
  EXPECT_EQ(eyes.views[1].width, 0.5);
  EXPECT_EQ(eyes.views[0].height, 1.0);
  // A near point lies further to the right for the left eye.
  EXPECT_GT(project(eyes.views[0], 0, 0, 40).x, project(eyes.views[1], 0, 0, 40).x);
}

TEST(Stereo, AnaglyphGivesRedToTheLeftEyeAndTheRestToTheRight) {
  const EyeViews eyes = eyeViews({.layout = StereoLayout::Anaglyph}, kVolume, kWidth, kHeight);
  ASSERT_EQ(eyes.count, 2);
  EXPECT_EQ(eyes.views[0].channels, (std::array{true, false, false}));
  EXPECT_EQ(eyes.views[1].channels, (std::array{false, true, true}));
  EXPECT_EQ(eyes.views[0].width, 1.0);
  EXPECT_GT(disparityMm(eyes, 0, 0, 40), 0.0);
}

TEST(Stereo, SwappedEyesTurnTheDisparityRound) {
  const EyeViews eyes = eyeViews({.swap_eyes = true}, kVolume, kWidth, kHeight);
  EXPECT_NEAR(disparityMm(eyes, 0, 0, 40), -2.172414, 1e-6);
}

TEST(Stereo, MonoSeesFromBetweenTheEyes) {
  const EyeViews mono = eyeViews({.layout = StereoLayout::Mono}, kVolume, kWidth, kHeight);
  ASSERT_EQ(mono.count, 1);
  EXPECT_NEAR(project(mono.views[0], 0, 0, 40).x, 0.0, 1e-12);
  EXPECT_EQ(mono.views[0].channels, (std::array{true, true, true}));
}

TEST(Stereo, EyesInOnePlaceSeeTheSame) {
  const EyeViews eyes = eyeViews({.eye_distance_mm = 0}, kVolume, kWidth, kHeight);
  EXPECT_NEAR(disparityMm(eyes, 30, 20, 40), 0.0, 1e-12);
}

}  // namespace
}  // namespace relievo
