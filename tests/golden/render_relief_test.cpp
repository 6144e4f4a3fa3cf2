// SPDX-License-Identifier: Apache-2.0
// The position of the relief: each eye's image of marked points against similar triangles.
#include <gtest/gtest.h>

#include <cmath>

#include "app/scene/height_field.h"
#include "tests/golden/picture_stage.h"
#include "tests/golden/relief_markers.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {
namespace {

TEST(RenderRelief, PlaneLiesWhereItsDepthSays) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  for (const double z : {0.0, 12.5, 20.0, 40.0}) {
    for (const Marker& marker : {Marker{320, 180}, Marker{60, 40}, Marker{590, 310}}) {
      SCOPED_TRACE(testing::Message() << "z " << z << ", marker at " << marker.x << ", " << marker.y);
      expectMarker(stage.show(sideBySide(marker, makePlane(160, 90, 16, code16(z)))), marker, z);
    }
  }
}

TEST(RenderRelief, StepHasEachSideAtItsDepth) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const auto step = makeGrayFrame(160, 90, 16, MediaTime{}, [](int c, int) { return code16(c < 80 ? 5.0 : 35.0); });
  expectMarker(stage.show(sideBySide({150, 120}, step)), {150, 120}, 5.0);
  expectMarker(stage.show(sideBySide({480, 240}, step)), {480, 240}, 35.0);
}

TEST(RenderRelief, SlopeIsDrawnBetweenItsSamples) {
  // z = 20 + 0.2 x on a grid of 17 x 10: a marker between samples lies on the straight line through them.
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const auto slope = makeReliefFrame(17, 10, kVolume, MediaTime{}, [](double x, double) { return 20.0 + 0.2 * x; });
  const Marker marker{437, 133};
  expectMarker(stage.show(sideBySide(marker, slope)), marker, 20.0 + 0.2 * marker.xMm());
}

TEST(RenderRelief, CellsAreSplitFromTopLeftToBottomRight) {
  // Two by two samples, only the top right one raised: the diagonal from top left to bottom right stays down, so its
  // middle is at 0. Split along the other diagonal it would be at half height, in the screen plane. The marker lies
  // across the fold, and the rise shifts its upper right half by at most half a pixel.
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const auto corner = makeGrayFrame(2, 2, 16, MediaTime{}, [](int c, int r) { return c == 1 && r == 0 ? 65535u : 0u; });
  const Image image = stage.show(sideBySide({320, 180}, corner));
  const double disparity = image.centroid(0, 0, 640).x - (image.centroid(0, 640, 1280).x - 640);
  EXPECT_NEAR(disparity, kPixelsPerMmX * kEyes * -20.0 / 620.0, 0.6);  // -8.1, against 0
}

TEST(RenderRelief, AnaglyphShowsTheLeftEyeInRed) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const Marker marker{200, 100};
  Scene scene = sideBySide(marker, makePlane(160, 90, 16, code16(40)));
  scene.stereo.layout = StereoLayout::Anaglyph;
  scene.stereo.anaglyph = AnaglyphColors::Color;
  const Image image = stage.show(scene);
  // The whole surface is one view: 8 pixels per mm across as well.
  const double left = 2 * onScreen(-kEyes / 2, marker.xMm(), marker.yMm(), 40).x;
  const double right = 2 * onScreen(kEyes / 2, marker.xMm(), marker.yMm(), 40).x;
  EXPECT_NEAR(image.centroid(0, 0, 1280).x, left, 0.25);
  EXPECT_NEAR(image.centroid(1, 0, 1280).x, right, 0.25);
  EXPECT_NEAR(image.centroid(2, 0, 1280).x, right, 0.25);
  EXPECT_GT(left, right + 10);
}

TEST(RenderRelief, NearerSurfaceHidesTheFartherForEachEyeOfAnAnaglyph) {
  // A red wall at the right, 40 high, before a green floor: its edge at x = 0 is seen by the left eye at
  // 31.5 * (600/580 - 1) = 1.086 mm to the right, by the right eye as far to the left, and the floor shows beside it.
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const Scene scene{.color = makeRgbFrame(kColorWidth, kColorHeight,
                                          [](int x, int) { return x < 320 ? Rgb{0, 255, 0} : Rgb{255, 0, 0}; }),
                    .depth = makeGrayFrame(640, 2, 16, MediaTime{}, [](int c, int) { return c < 320 ? 0u : 65535u; }),
                    .calibration = {.bits = 16},
                    .volume = kVolume,
                    .stereo = {.layout = StereoLayout::Anaglyph, .anaglyph = AnaglyphColors::Color}};
  const Image image = stage.show(scene);
  const int middle = 640;
  const int edge = 9;  // 8 pixels a mm x 1.086 = 8.7
  // Right eye, in green: the floor ends where the wall begins, left of the middle.
  EXPECT_GT(image.channel(middle - edge - 3, 360, 1), 250);
  EXPECT_LT(image.channel(middle - edge + 3, 360, 1), 5);
}

// Code 0 is the far plane where no code is invalid.
TEST(RenderRelief, APictureOfCodesZeroIsVisibleWithoutAnInvalidCode) {
  STAGE_OR_SKIP(stage, 640, 360);
  const Scene scene{.color = makeRgbFrame(32, 18, [](int, int) { return Rgb{255, 255, 255}; }),
                    .depth = makeGrayFrame(32, 18, 8, MediaTime{}, [](int, int) { return 0u; }),
                    .volume = kVolume};
  EXPECT_EQ(stage.show(scene).at(320, 180), (Rgb{255, 255, 255}));
}

TEST(RenderRelief, HoleIsFilledWithTheFartherOfItsSides) {
  // A wall, 40 mm high, left of a hole; the floor right of it. The hole is black in the depth and white in the picture.
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const auto depth = makeGrayFrame(160, 90, 8, MediaTime{}, [](int c, int) {
    return c < 60 ? 255u : c < 90 ? 7u : 0u;
  });
  const Marker marker{300, 180};  // over the hole: columns 60 to 89 are pixels 240 to 359
  Scene scene = sideBySide(marker, depth);
  scene.calibration = {.invalid = 7};
  expectMarker(stage.show(scene), marker, 0.0);
}

TEST(RenderRelief, NoGapOpensBesideANearThing) {
  // A wall 40 mm high in the middle of a floor, all white: whatever an eye uncovers beside it is white too.
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  Scene scene{.color = makeRgbFrame(32, 18, [](int, int) { return Rgb{255, 255, 255}; }),
              .depth = makeGrayFrame(160, 90, 8, MediaTime{},
                                     [](int c, int r) { return std::hypot(c - 110, r - 30) < 20 ? 255u : 0u; }),
              .volume = kVolume,
              .stereo = {.layout = StereoLayout::SideBySide, .strength = 2.0}};
  const Image image = stage.show(scene);
  EXPECT_EQ(image.centroid(0, 0, kSurfaceWidth).weight, kSurfaceWidth * kSurfaceHeight);
}

TEST(RenderRelief, WhatIsUncoveredBesideANearThingIsTheFarThings) {
  // A red wall at the right, 40 mm high, in front of a green floor: past the wall's edge at x = 40 the left eye sees
  // (40 + 31.5) * 40 / 580 = 4.9 mm of floor that the picture lacks, and it must appear green.
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const Scene scene{.color = makeRgbFrame(kColorWidth, kColorHeight,
                                          [](int x, int) { return x < 480 ? Rgb{0, 255, 0} : Rgb{255, 0, 0}; }),
                    .depth = makeGrayFrame(640, 360, 16, MediaTime{}, [](int c, int) { return c < 480 ? 0u : 65535u; }),
                    .calibration = {.bits = 16},
                    .volume = kVolume,
                    .stereo = {.layout = StereoLayout::SideBySide}};
  const Image image = stage.show(scene);
  // The wall's edge, by similar triangles, and the floor right before it: 4 pixels a mm.
  const int edge = static_cast<int>(onScreen(-kEyes / 2, 40, 0, 40).x);
  for (int x = edge - 25; x < edge - 2; ++x) {
    EXPECT_EQ(image.at(x, 360), (Rgb{0, 255, 0})) << x - edge;
  }
  EXPECT_EQ(image.at(edge + 3, 360), (Rgb{255, 0, 0}));
}

TEST(RenderRelief, WithoutDepthThePictureIsFlatAndTheSameForBothEyes) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const Marker marker{600, 330};
  const Image image = stage.show(sideBySide(marker, {}));
  expectMarker(image, marker, kScreenZ);
  EXPECT_EQ(stage.renderer().statistics().triangles, 0U);
}

TEST(RenderRelief, TheSameDepthAfterAFlatPictureIsDrawnAsBefore) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const Marker marker{200, 100};
  const Scene relief = sideBySide(marker, makePlane(160, 90, 16, code16(35)));
  const Image before = stage.show(relief);
  EXPECT_EQ(stage.show(relief).meanDifference(before), 0);
  EXPECT_GT(stage.show(sideBySide(marker, {})).meanDifference(before), 0);
  EXPECT_EQ(stage.show(relief).meanDifference(before), 0);
}

TEST(RenderRelief, LetterboxKeepsTheAspect) {
  // 160 x 90 mm on a square of 720: 4.5 pixels a mm both ways, 405 rows from 157.5 on.
  STAGE_OR_SKIP(stage, 720, 720);
  const Scene scene{.color = makeRgbFrame(32, 18, [](int, int) { return Rgb{255, 255, 255}; }), .volume = kVolume};
  const Image image = stage.show(scene);
  EXPECT_EQ(image.at(360, 150), (Rgb{0, 0, 0}));
  EXPECT_EQ(image.at(360, 165), (Rgb{255, 255, 255}));
  EXPECT_EQ(image.at(2, 360), (Rgb{255, 255, 255}));
  EXPECT_EQ(image.at(717, 555), (Rgb{255, 255, 255}));
  EXPECT_EQ(image.at(360, 570), (Rgb{0, 0, 0}));
  EXPECT_NEAR(image.centroid(0, 0, 720).weight, 720.0 * 405.0, 720.0);
}

TEST(RenderRelief, LetterboxOfSideBySideIsSqueezedWithTheHalf) {
  // A picture of 90 x 90 mm on 1280 x 720: 720 pixels wide once the half is stretched to the full width, 360 in the
  // half.
  STAGE_OR_SKIP(stage, 1280, 720);
  const Scene scene{.color = makeRgbFrame(20, 20, [](int, int) { return Rgb{255, 255, 255}; }),
                    .volume = {90.0, 90.0, 40.0},
                    .stereo = {.layout = StereoLayout::SideBySide}};
  const Image image = stage.show(scene);
  const int first = (640 - 360) / 2;
  EXPECT_EQ(image.at(first - 3, 360), (Rgb{0, 0, 0}));
  EXPECT_EQ(image.at(first + 3, 360), (Rgb{255, 255, 255}));
  EXPECT_EQ(image.at(first + 357, 360), (Rgb{255, 255, 255}));
  EXPECT_EQ(image.at(first + 363, 360), (Rgb{0, 0, 0}));
  EXPECT_EQ(image.at(640 + first + 3, 3), (Rgb{255, 255, 255}));
  EXPECT_EQ(image.at(640 + first - 3, 3), (Rgb{0, 0, 0}));
}

TEST(RenderRelief, FarSurfaceLeavesNoGapBesideItsFrame) {
  // A plane 20 behind the screen is seen 3 % smaller; the frame joins it to the picture's edge.
  STAGE_OR_SKIP(stage, 640, 360);
  const Scene scene{.color = makeRgbFrame(32, 18, [](int, int) { return Rgb{255, 255, 255}; }),
                    .depth = makePlane(32, 18, 8, 0),
                    .volume = kVolume};
  const Image image = stage.show(scene);
  for (const auto& [x, y] : {std::pair{0, 0}, {639, 0}, {0, 359}, {639, 359}, {320, 0}, {0, 180}}) {
    EXPECT_EQ(image.at(x, y), (Rgb{255, 255, 255})) << x << ", " << y;
  }
}

}  // namespace
}  // namespace relievo::test
