// SPDX-License-Identifier: Apache-2.0
// A renderer that has no time draws smaller views, which show the same picture at the same place.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/golden/picture_stage.h"

namespace relievo::test {
namespace {

constexpr int kWidth = 256, kHeight = 144;

// Broad bands, so that half the pixels show them too.
Scene bands(StereoLayout layout) {
  Scene scene;
  scene.color = makeRgbFrame(64, 36, [](int x, int y) -> Rgb { return {x < 32 ? 220 : 40, y < 18 ? 200 : 60, 90}; });
  scene.depth = makePlane(64, 36, 8, 128);
  scene.volume = {160.0, 90.0, 40.0};
  scene.stereo.layout = layout;
  return scene;
}

// The stage's budget for a frame is far more than drawing takes; this one can never be kept.
Image shownWithoutTime(Stage& stage, const Scene& scene) {
  stage.renderer().setFrameBudget(Duration(1));
  Image image = stage.show(scene);
  for (int i = 0; i < 100 && stage.renderer().statistics().size > 0.5; ++i) image = stage.again();
  return stage.again();
}

class RenderReduced : public testing::TestWithParam<StereoLayout> {};

TEST_P(RenderReduced, ASmallerViewShowsTheSamePicture) {
  STAGE_OR_SKIP(stage, kWidth, kHeight);
  const Image whole = stage.show(bands(GetParam()));
  ASSERT_EQ(stage.renderer().statistics().size, 1.0);
  const Image reduced = shownWithoutTime(stage, bands(GetParam()));
  EXPECT_EQ(stage.renderer().statistics().size, 0.5);
  EXPECT_LT(reduced.meanDifference(whole), 2.5);  // the bands' edges are softer by a pixel
  EXPECT_GT(reduced.meanDifference(whole), 0.0) << "it was drawn as large as before";
  int least_opaque = 255;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) least_opaque = std::min(least_opaque, reduced.channel(x, y, 3));
  }
  EXPECT_EQ(least_opaque, 255);
}

// Before the clock starts, so that no picture of the film is left out until the size fits.
TEST(RenderReduced, ARehearsalFindsTheSizeThatHoldsAtOnce) {
  STAGE_OR_SKIP(stage, kWidth, kHeight);
  const Image whole = stage.show(bands(StereoLayout::SideBySide));
  EXPECT_TRUE(stage.rehearse());
  EXPECT_EQ(stage.renderer().statistics().size, 1.0) << "there is time enough";
  EXPECT_EQ(stage.again().meanDifference(whole), 0.0) << "nothing of the rehearsal stays";
  stage.renderer().setFrameBudget(Duration(1));
  EXPECT_TRUE(stage.rehearse());
  EXPECT_EQ(stage.renderer().statistics().size, 0.5);
}

// A drawing of 4K takes a software driver a tenth of a second, a rehearsal two.
TEST(RenderReduced, ARehearsalEndsWhenTheProgramShall) {
  STAGE_OR_SKIP(stage, kWidth, kHeight);
  ASSERT_TRUE(stage.tryShow(bands(StereoLayout::SideBySide)));
  stage.renderer().setFrameBudget(Duration(1));
  EXPECT_TRUE(stage.rehearse(true));
  EXPECT_EQ(stage.renderer().statistics().size, 1.0) << "it went on";
}

INSTANTIATE_TEST_SUITE_P(Layouts, RenderReduced,
                         testing::Values(StereoLayout::Mono, StereoLayout::SideBySide, StereoLayout::Rows));

}  // namespace
}  // namespace relievo::test
