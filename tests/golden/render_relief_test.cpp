// SPDX-License-Identifier: Apache-2.0
// The position of the relief: each eye's image of marked points against similar triangles, and the height that the two
// eyes see against the height that the finger feels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/scene/height_field.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {
namespace {

// Half of a side-by-side surface is 640 x 720 and shows 160 x 90 mm: 4 pixels a mm across, 8 down.
constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};
constexpr int kSurfaceWidth = 1280, kSurfaceHeight = 720;
constexpr double kPixelsPerMmX = 4.0, kPixelsPerMmY = 8.0;
constexpr int kColorWidth = 640, kColorHeight = 360;
constexpr double kEyes = 63.0, kDistance = 600.0, kScreenZ = 20.0;

// A white square of 9 x 9 pixels on black, and the position of its middle in the scene.
struct Marker {
  int x, y;
  [[nodiscard]] double xMm() const { return ((x + 0.5) / kColorWidth - 0.5) * kVolume.width_mm; }
  [[nodiscard]] double yMm() const { return (0.5 - (y + 0.5) / kColorHeight) * kVolume.height_mm; }
};

Frame markerPicture(const Marker& marker) {
  return makeRgbFrame(kColorWidth, kColorHeight, [&](int x, int y) {
    const bool lit = std::abs(x - marker.x) <= 4 && std::abs(y - marker.y) <= 4;
    return lit ? Rgb{255, 255, 255} : Rgb{0, 0, 0};
  });
}

// The point where the ray from the eye through (x, y, z) meets the screen plane, in pixels of the eye's half from the
// top left.
struct Pixel {
  double x, y;
};
Pixel onScreen(double eye_x, double x, double y, double z) {
  const double grow = kDistance / (kDistance - (z - kScreenZ));
  return {(eye_x + (x - eye_x) * grow + 80.0) * kPixelsPerMmX, (45.0 - y * grow) * kPixelsPerMmY};
}

std::uint32_t code16(double z) {
  return static_cast<std::uint32_t>(std::lround(z / kVolume.depth_mm * 65535.0));
}

Scene sideBySide(const Marker& marker, Frame depth) {
  return {.color = markerPicture(marker),
          .depth = std::move(depth),
          .calibration = {.bits = 16},
          .volume = kVolume,
          .stereo = {.layout = StereoLayout::SideBySide}};
}

void expectMarker(const Image& image, const Marker& marker, double z) {
  const Spot left = image.centroid(0, 0, 640);
  const Spot right = image.centroid(0, 640, 1280);
  const Pixel left_paper = onScreen(-kEyes / 2, marker.xMm(), marker.yMm(), z);
  const Pixel right_paper = onScreen(kEyes / 2, marker.xMm(), marker.yMm(), z);
  EXPECT_NEAR(left.x, left_paper.x, 0.25);
  EXPECT_NEAR(right.x - 640, right_paper.x, 0.25);
  EXPECT_NEAR(left.y, left_paper.y, 0.25);
  EXPECT_NEAR(left.y, right.y, 0.05) << "vertical parallax";
  // x_left - x_right = e h / (d - h), to within a quarter of a pixel.
  const double h = z - kScreenZ;
  EXPECT_NEAR(left.x - (right.x - 640), kPixelsPerMmX * kEyes * h / (kDistance - h), 0.25);
}

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

// The height at which the two eyes see the surface, from the disparity of a marker: h = p d / (e + p).
double heightSeen(Stage& stage, Frame depth, const DepthCalibration& calibration) {
  constexpr double kWideEyes = 400.0;
  Scene scene = sideBySide({320, 180}, std::move(depth));
  scene.calibration = calibration;
  scene.stereo.eye_distance_mm = kWideEyes;
  const Image image = stage.show(scene);
  const double disparity = image.centroid(0, 0, 640).x - (image.centroid(0, 640, 1280).x - 640);
  const double p = disparity / kPixelsPerMmX;
  return kScreenZ + p * kDistance / (kWideEyes + p);
}

void expectHeightFelt(Stage& stage, const Frame& depth, const DepthCalibration& calibration) {
  const double felt = HeightField::make(depth, calibration, kVolume).value().heightMm(0, 0);
  EXPECT_NEAR(heightSeen(stage, depth, calibration), felt, 0.1) << "code law " << static_cast<int>(calibration.law);
}

TEST(RenderRelief, EyesSeeTheHeightThatTheFingerFeels) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  for (const std::uint32_t code : {0u, 16u, 77u, 200u, 235u, 255u}) {
    for (const ColorRange range : {ColorRange::Full, ColorRange::Limited}) {
      for (const DepthPolarity polarity : {DepthPolarity::NearIsHigh, DepthPolarity::NearIsLow}) {
        for (const DepthLaw law : {DepthLaw::Linear, DepthLaw::Inverse}) {
          SCOPED_TRACE(testing::Message() << "code " << code << ", range " << static_cast<int>(range) << ", polarity "
                                          << static_cast<int>(polarity));
          expectHeightFelt(stage, makePlane(32, 18, 8, code), {.law = law, .polarity = polarity, .range = range});
        }
      }
    }
  }
}

TEST(RenderRelief, HeightsOfKnownCodesAreRightOnPaper) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  EXPECT_NEAR(heightSeen(stage, makePlane(32, 18, 8, 51), {}), 8.0, 0.1);  // 51/255 = 1/5 of 40
  // Inverse, 500 to 5000 mm: s = 0.2 is Z = 1/(0.2/500 + 0.8/5000) = 1785.7, z = 40 * 3214.3/4500 = 28.571.
  EXPECT_NEAR(heightSeen(stage, makePlane(32, 18, 8, 51), {.law = DepthLaw::Inverse}), 28.571, 0.1);
  // Limited: (51 - 16)/219 of 40 = 6.393; with near low, 40 minus that.
  EXPECT_NEAR(heightSeen(stage, makePlane(32, 18, 8, 51), {.range = ColorRange::Limited}), 6.393, 0.1);
  EXPECT_NEAR(heightSeen(stage, makePlane(32, 18, 8, 51), {.polarity = DepthPolarity::NearIsLow}), 32.0, 0.1);
}

TEST(RenderRelief, DeepCodesAreReadByTheirBitsAndShift) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  expectHeightFelt(stage, makePlane(32, 18, 10, 300), {.bits = 10});
  expectHeightFelt(stage, makePlane(32, 18, 10, 300), {.range = ColorRange::Limited, .bits = 10});
  expectHeightFelt(stage, makePlane(32, 18, 16, 50'000), {.bits = 16});
  // P010 keeps its ten bits at the top of the word; the bits below are ignored.
  Frame high = makePlane(32, 18, 16, 300u << 6 | 0x2au);
  high.components[0].bits = 10;
  high.components[0].shift = 6;
  expectHeightFelt(stage, high, {.bits = 10});
  EXPECT_NEAR(heightSeen(stage, high, {.bits = 10}), 40.0 * 300 / 1023, 0.1);
}

TEST(RenderRelief, CodesBetweenOtherSamplesAreFound) {
  // Luma in every second byte, after a chroma byte: the packing of UYVY.
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  Frame packed = makePlane(64, 18, 8, 0);
  auto bytes = std::make_shared<std::vector<std::uint8_t>>(64 * 18);
  for (std::size_t i = 0; i < bytes->size(); ++i) (*bytes)[i] = i % 2 == 1 ? 102 : 240;
  packed.width = 32;
  packed.components[0] = {.offset_bytes = 1, .step_bytes = 2};
  packed.planes[0] = {bytes->data(), 64};
  packed.owner = bytes;
  EXPECT_NEAR(heightSeen(stage, packed, {}), 16.0, 0.1);  // 102/255 of 40
}

// The standard hexagon's hue for s, as footage in this coding stores it.
Rgb hueColor(double s) {
  const double sixth = s * 6.0;
  const auto ramp = [&](double centre) {
    double away = std::abs(sixth - centre);
    away = std::min(away, 6.0 - away);
    return static_cast<int>(std::lround(255.0 * std::clamp(2.0 - away, 0.0, 1.0)));
  };
  return {ramp(0), ramp(2), ramp(4)};
}

constexpr DepthCalibration kHue{.polarity = DepthPolarity::NearIsLow, .code = DepthCode::Hue};

TEST(RenderRelief, HueIsReadRoundTheWholeCircle) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  for (const double s : {0.0, 0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 0.95}) {
    SCOPED_TRACE(s);
    const Frame hue = makeRgbFrame(32, 18, [s](int, int) { return hueColor(s); }, {.step = 4});
    EXPECT_NEAR(heightSeen(stage, hue, kHue), 40.0 * (1.0 - s), 0.15);
    expectHeightFelt(stage, hue, kHue);
  }
}

TEST(RenderRelief, HueAndLumaOfTheSameReliefGiveTheSamePicture) {
  STAGE_OR_SKIP(stage, kSurfaceWidth, kSurfaceHeight);
  const auto s = [](int c, int r) { return 0.5 + 0.35 * std::sin(c * 0.07) * std::cos(r * 0.09); };
  Scene scene{.color = makeRgbFrame(160, 90, [](int x, int y) { return Rgb{x, 255 - x, (x / 8 + y / 8) % 2 * 255}; }),
              .depth = makeRgbFrame(160, 90, [&](int c, int r) { return hueColor(s(c, r)); },
                                    {.step = 4, .offsets = {2, 1, 0}}),
              .calibration = kHue,
              .volume = kVolume,
              .stereo = {.layout = StereoLayout::SideBySide}};
  const Image by_hue = stage.show(scene);
  scene.depth = makeGrayFrame(160, 90, 16, MediaTime{}, [&](int c, int r) { return 65535.0 * (1.0 - s(c, r)); });
  scene.calibration = {.bits = 16};
  const Image by_luma = stage.show(scene);
  // A hue of 1530 steps is 0.013 mm off at most: a hundredth of a pixel of disparity.
  EXPECT_LT(by_hue.meanDifference(by_luma), 0.2);
  scene.depth = makePlane(160, 90, 16, 32768);
  EXPECT_GT(by_hue.meanDifference(stage.show(scene)), 2.0);  // and the relief is in the picture
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
