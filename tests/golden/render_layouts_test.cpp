// SPDX-License-Identifier: Apache-2.0
// Every stereo layout against an independent reference: rays from each eye are marched into a relief given by a formula
// and combined as the layout says. It shares no code with the renderer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/lab/detail/picture_quality.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {
namespace {

constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};
constexpr double kDistance = 600, kScreenZ = 20, kEyes = 63;

double relief(double x, double y) {
  return 6 + 26 * std::exp(-((x - 15) * (x - 15) + y * y) / (2 * 28.0 * 28.0)) + 0.03 * x;
}

// Smooth enough to be insensitive to antialiasing, yet a shift of one pixel is detected.
Rgb paint(double x, double y) {
  const auto wave = [](double phase) { return static_cast<int>(std::lround(127.5 + 120 * std::sin(phase))); };
  return {wave(1.5 * x + 0.2 * y), wave(1.1 * x - 0.5 * y), wave(0.9 * (x + y) + 2)};
}

// The colour that an eye at (eye_x, 0, 620) sees through the point (x, y, 20) of the screen plane.
Rgb seen(double eye_x, double x, double y) {
  const auto above = [&](double z) {
    const double along = (kDistance + kScreenZ - z) / kDistance;
    return z - relief(eye_x + (x - eye_x) * along, y * along);
  };
  double high = 45, low = high;
  while (low > 0 && above(low) > 0) low -= 0.5;
  high = low + 0.5;
  for (int i = 0; i < 20; ++i) (above(0.5 * (low + high)) > 0 ? high : low) = 0.5 * (low + high);
  const double along = (kDistance + kScreenZ - low) / kDistance;
  return paint(eye_x + (x - eye_x) * along, y * along);
}

// An eye's picture of the whole window, `width` x `height` pixels.
DrawnPicture view(double eye_x, int width, int height) {
  DrawnPicture picture{width, height, {}};
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const double x = ((c + 0.5) / width - 0.5) * kVolume.width_mm, y = (0.5 - (r + 0.5) / height) * kVolume.height_mm;
      for (const int value : seen(eye_x, x, y)) picture.rgba.push_back(static_cast<std::uint8_t>(value));
      picture.rgba.push_back(255);
    }
  }
  return picture;
}

void paste(const DrawnPicture& part, int x, int y, DrawnPicture& whole) {
  for (int r = 0; r < part.height; ++r) {
    std::copy_n(part.rgba.begin() + static_cast<std::ptrdiff_t>(r) * part.width * 4, part.width * 4,
                whole.rgba.begin() + (static_cast<std::ptrdiff_t>(y + r) * whole.width + x) * 4);
  }
}

DrawnPicture black(int width, int height) {
  DrawnPicture picture{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 4, 0)};
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
  return picture;
}

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

Scene sceneIn(const StereoSettings& stereo) {
  constexpr int kWidth = 1280, kHeight = 720;
  return {.color = makeRgbFrame(kWidth, kHeight,
                                [](int c, int r) {
                                  return paint(((c + 0.5) / kWidth - 0.5) * kVolume.width_mm,
                                               (0.5 - (r + 0.5) / kHeight) * kVolume.height_mm);
                                }),
          .depth = makeReliefFrame(640, 360, kVolume, MediaTime{}, relief),
          .calibration = {.bits = 16},
          .volume = kVolume,
          .stereo = stereo,
          .error_px = 0.5};
}

// At the picture's edge the relief is joined to the frame, so a few pixels there are ignored.
double similarity(const Image& image, const DrawnPicture& golden, int rim) {
  std::vector<std::uint8_t> counted(static_cast<std::size_t>(golden.width) * golden.height, 0);
  for (int r = rim; r < golden.height - rim; ++r) {
    for (int c = rim; c < golden.width - rim; ++c) counted[static_cast<std::size_t>(r) * golden.width + c] = 1;
  }
  PictureError error;
  error.add(differenceOf({image.width, image.height, image.rgba}, golden), counted);
  return error.similarity();
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

TEST(RenderLayouts, Mono) {
  expectLike({.layout = Mono}, view(0, 640, 360));
}

TEST(RenderLayouts, SideBySide) {
  DrawnPicture golden = black(1280, 720);
  paste(view(-kEyes / 2, 640, 720), 0, 0, golden);
  paste(view(kEyes / 2, 640, 720), 640, 0, golden);
  expectLike({.layout = SideBySide}, golden);
}

TEST(RenderLayouts, SideBySideInFull) {
  DrawnPicture golden = black(1280, 360);
  paste(view(-kEyes / 2, 640, 360), 0, 0, golden);
  paste(view(kEyes / 2, 640, 360), 640, 0, golden);
  expectLike({.layout = SideBySide, .full = true}, golden);
}

TEST(RenderLayouts, TopBottom) {
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

TEST(RenderLayouts, Rows) {
  expectLike({.layout = Rows},
             mixed(640, 360, [](int, int r, auto left, auto right) { return r % 2 == 0 ? left : right; }));
}

TEST(RenderLayouts, Columns) {
  expectLike({.layout = Columns},
             mixed(640, 360, [](int c, int, auto left, auto right) { return c % 2 == 0 ? left : right; }));
}

TEST(RenderLayouts, AnaglyphOfPlainColours) {
  const auto golden =
      mixed(640, 360, [](int, int, auto left, auto right) { return std::array{left[0], right[1], right[2]}; });
  expectLike({.layout = Anaglyph, .anaglyph = AnaglyphColors::Color}, golden);
}

TEST(RenderLayouts, AnaglyphInGray) {
  const auto golden = mixed(640, 360, [](int, int, auto left, auto right) {
    const auto gray = [](const auto& rgb) { return 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2]; };
    return std::array{gray(left), gray(right), gray(right)};
  });
  expectLike({.layout = Anaglyph, .anaglyph = AnaglyphColors::Gray}, golden);
}

TEST(RenderLayouts, AnaglyphByLeastSquares) {
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
