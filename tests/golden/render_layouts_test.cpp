// SPDX-License-Identifier: Apache-2.0
// Every stereo layout against an independent reference: rays from each eye are marched into a relief given by a formula
// and combined as the layout says. It shares no code with the renderer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/golden/picture_stage.h"
#include "tests/golden/ray_pictures.h"

namespace relievo::test {
namespace {

// Combines both eyes pixel by pixel.
template <class Mix>
DrawnPicture mixed(int width, int height, Mix&& mix) {
  const DrawnPicture left = view(-kEyes / 2, width, height), right = view(kEyes / 2, width, height);
  DrawnPicture whole = black(width, height);
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const std::size_t at = (static_cast<std::size_t>(r) * width + c) * 4;
      const auto of = [at](const DrawnPicture& p) {
        return std::array<double, 3>{1.0 * p.rgba[at], 1.0 * p.rgba[at + 1], 1.0 * p.rgba[at + 2]};
      };
      const auto color = mix(c, r, of(left), of(right));
      for (std::size_t k = 0; k < 3; ++k) {
        whole.rgba[at + k] = static_cast<std::uint8_t>(std::lround(std::clamp(color[k], 0.0, 255.0)));
      }
    }
  }
  return whole;
}

void expectLike(const StereoSettings& stereo, const DrawnPicture& golden, int rim = 6) {
  const auto stage = Stage::make(golden.width, golden.height);
  if (!stage) GTEST_SKIP() << "this machine has no EGL with GLES 3";
  const Image image = stage->show(sceneIn(stereo));
  EXPECT_GT(similarity(image, golden, rim), 0.97) << name(stereo.layout);
  StereoSettings swapped = stereo;
  swapped.swap_eyes = true;
  const double of_swapped = similarity(stage->show(sceneIn(swapped)), golden, rim);
  if (stereo.layout == StereoLayout::Mono) return;
  EXPECT_LT(of_swapped, 0.96) << "with swapped eyes the picture must differ";
}

using enum StereoLayout;

TEST(RenderLayouts, MonoIsSeenFromBetweenTheEyes) {
  expectLike({.layout = Mono}, view(0, 640, 360));
}

TEST(RenderLayouts, SideBySideHasTheLeftEyesViewOnTheLeft) {
  DrawnPicture golden = black(1280, 720);
  paste(view(-kEyes / 2, 640, 720), 0, 0, golden);
  paste(view(kEyes / 2, 640, 720), 640, 0, golden);
  expectLike({.layout = SideBySide}, golden);
}

TEST(RenderLayouts, SideBySideInFullKeepsTheAspectRatioOfEachView) {
  DrawnPicture golden = black(1280, 360);
  paste(view(-kEyes / 2, 640, 360), 0, 0, golden);
  paste(view(kEyes / 2, 640, 360), 640, 0, golden);
  expectLike({.layout = SideBySide, .full = true}, golden);
}

TEST(RenderLayouts, TopBottomHasTheLeftEyesViewAbove) {
  DrawnPicture golden = black(1280, 720);
  paste(view(-kEyes / 2, 1280, 360), 0, 0, golden);
  paste(view(kEyes / 2, 1280, 360), 0, 360, golden);
  expectLike({.layout = TopBottom}, golden);
}

TEST(RenderLayouts, FramePackingHasItsGap) {
  DrawnPicture golden = black(1280, 1470);
  paste(view(-kEyes / 2, 1280, 720), 0, 0, golden);
  paste(view(kEyes / 2, 1280, 720), 0, 750, golden);
  expectLike({.layout = FramePacking}, golden);
  const auto stage = Stage::make(1280, 1470);
  if (!stage) GTEST_SKIP() << "this machine has no EGL with GLES 3";
  const Image image = stage->show(sceneIn({.layout = FramePacking}));
  for (int r = 720; r < 750; ++r) EXPECT_EQ(image.at(640, r), (Rgb{0, 0, 0})) << r;
  EXPECT_NE(image.at(640, 719), (Rgb{0, 0, 0}));
  EXPECT_NE(image.at(640, 750), (Rgb{0, 0, 0}));
}

TEST(RenderLayouts, EvenRowsShowTheLeftEyesView) {
  expectLike({.layout = Rows},
             mixed(640, 360, [](int, int r, auto left, auto right) { return r % 2 == 0 ? left : right; }));
}

TEST(RenderLayouts, EvenColumnsShowTheLeftEyesView) {
  expectLike({.layout = Columns},
             mixed(640, 360, [](int c, int, auto left, auto right) { return c % 2 == 0 ? left : right; }));
}

TEST(RenderLayouts, AnaglyphOfPlainColoursTakesRedFromTheLeftEye) {
  const auto golden =
      mixed(640, 360, [](int, int, auto left, auto right) { return std::array{left[0], right[1], right[2]}; });
  expectLike({.layout = Anaglyph, .anaglyph = AnaglyphColors::Color}, golden);
}

TEST(RenderLayouts, AnaglyphInGrayShowsTheLeftEyesBrightnessInRed) {
  const auto golden = mixed(640, 360, [](int, int, auto left, auto right) {
    const auto gray = [](const auto& rgb) { return 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2]; };
    return std::array{gray(left), gray(right), gray(right)};
  });
  expectLike({.layout = Anaglyph, .anaglyph = AnaglyphColors::Gray}, golden);
}

TEST(RenderLayouts, AnaglyphMixesByThePublishedLeastSquares) {
  // The published numbers, in thousandths.
  const auto golden = mixed(640, 360, [](int, int, auto l, auto r) {
    return std::array{(456 * l[0] + 500 * l[1] + 176 * l[2] - 43 * r[0] - 88 * r[1] - 2 * r[2]) / 1000,
                      (-40 * l[0] - 38 * l[1] - 16 * l[2] + 378 * r[0] + 734 * r[1] - 18 * r[2]) / 1000,
                      (-15 * l[0] - 21 * l[1] - 5 * l[2] - 72 * r[0] - 113 * r[1] + 1226 * r[2]) / 1000};
  });
  expectLike({.layout = Anaglyph}, golden);
}

TEST(RenderLayouts, QuiltBeginsAtTheLowerLeft) {
  DrawnPicture golden = black(1280, 720);
  for (int k = 0; k < 4; ++k) paste(view(-126 + 84.0 * k, 640, 360), k % 2 * 640, 360 - k / 2 * 360, golden);
  expectLike({.layout = Quilt, .quilt_cols = 2, .quilt_rows = 2}, golden);
}

TEST(RenderLayouts, EachEyeOfTwoViewsSeesItsOwnPicture) {
  const auto stage = Stage::make(640, 360);
  if (!stage) GTEST_SKIP() << "this machine has no EGL with GLES 3";
  Scene scene{.color = makePlane(160, 90, 8, 60), .volume = kVolume, .right = makePlane(160, 90, 8, 200)};
  const auto lightAt = [&](int x, int y) { return stage->show(scene).at(x, y)[0]; };
  EXPECT_NEAR(lightAt(320, 180), 60, 2) << "mono: the left one";
  scene.stereo = {.layout = SideBySide};
  EXPECT_NEAR(lightAt(160, 180), 60, 2);
  EXPECT_NEAR(lightAt(480, 180), 200, 2);
  scene.stereo.swap_eyes = true;
  EXPECT_NEAR(lightAt(160, 180), 200, 2);
  EXPECT_NEAR(lightAt(480, 180), 60, 2);
  scene.stereo = {.layout = Rows};
  EXPECT_NEAR(lightAt(320, 180), 60, 2);
  EXPECT_NEAR(lightAt(320, 181), 200, 2);
  scene.right = {};
  EXPECT_NEAR(lightAt(320, 181), 60, 2) << "one view again";
}

}  // namespace
}  // namespace relievo::test
