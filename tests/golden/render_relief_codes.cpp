// SPDX-License-Identifier: Apache-2.0
// The height that two eyes see for each code, against the height that the finger feels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/golden/relief_markers.h"

namespace relievo::test {
namespace {

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

}  // namespace
}  // namespace relievo::test
