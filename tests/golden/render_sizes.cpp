// SPDX-License-Identifier: Apache-2.0
// Pictures of odd, tiny and huge sizes, changes from frame to frame, and what cannot be drawn.
#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "drivers/egl/egl.h"
#include "tests/golden/picture_stage.h"
#include "tests/golden/yuv_frames.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {
namespace {

TEST(RenderFormats, OddSizesAreWhole) {
  STAGE_OR_SKIP(stage, 640, 480);
  const DisplayVolume volume{160, 120, 40};
  for (const auto& [width, height] : {std::pair{719, 485}, {161, 7}}) {
    for (const bool semi_planar : {false, true}) {
      SCOPED_TRACE(testing::Message() << width << " x " << height << (semi_planar ? " nv12" : " i420"));
      const Frame color = makeYuvFrame(width, height, {.name = "", .semi_planar = semi_planar, .padding = 1});
      expectBars(stage.show({.color = color, .volume = volume}), 3);
      // And with a depth of the same odd size, in the screen plane.
      const Frame depth = makePlane(width, height, 16, 32768);
      expectBars(stage.show({.color = color, .depth = depth, .calibration = {.bits = 16}, .volume = volume}), 3);
    }
  }
}

TEST(RenderFormats, ThreeByFivePixelsStandWhereTheyShould) {
  STAGE_OR_SKIP(stage, 300, 500);
  const auto color = [](int x, int y) { return Rgb{x * 100 + 20, y * 50 + 10, (x + y) * 30}; };
  const Scene scene{.color = makeRgbFrame(3, 5, color),
                    .depth = makePlane(3, 5, 16, 32768),
                    .calibration = {.bits = 16},
                    .volume = {90, 150, 40}};
  const Image image = stage.show(scene);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 3; ++x) expectColor(image, x * 100 + 50, y * 100 + 50, color(x, y), 3);
  }
}

TEST(RenderFormats, OnePixelFillsItsFrame) {
  STAGE_OR_SKIP(stage, 160, 160);
  const Frame depth = makePlane(1, 1, 8, 90);
  for (const Frame& color : {makeRgbFrame(1, 1, [](int, int) { return Rgb{200, 100, 50}; }), makePlane(1, 1, 8, 77),
                             makeYuvFrame(1, 1, {.name = ""})}) {
    const Rgb shown = color.model == ColorModel::Rgb    ? Rgb{200, 100, 50}
                      : color.model == ColorModel::Gray ? Rgb{77, 77, 77}
                                                        : bar(0.5);
    const Image image = stage.show({.color = color, .depth = depth, .volume = {40, 40, 40}});
    for (const auto& [x, y] : {std::pair{2, 2}, {80, 80}, {157, 157}}) expectColor(image, x, y, shown, 3);
  }
}

TEST(RenderFormats, AVideoOfEightThousandLinesIsShown) {
  STAGE_OR_SKIP(stage, 320, 320);
  const auto quarter = [](int c, int r) { return std::uint32_t(c < 4096 ? 200 : 60) - (r < 4096 ? 0 : 40); };
  const Frame samples = makeGrayFrame(8192, 8192, 8, MediaTime{}, quarter);
  Scene scene{.color = samples, .depth = samples, .volume = {80, 80, 4}};
  const Image image = stage.show(scene);
  for (const auto& [x, y, gray] : {std::array{80, 80, 200}, {240, 80, 60}, {80, 240, 160}, {240, 240, 20}}) {
    expectColor(image, x, y, {gray, gray, gray}, 2);
  }
  EXPECT_GT(stage.renderer().statistics().cut_cells, 0U) << "its depth as well";
}

TEST(RenderFormats, WhatNoTextureHoldsIsRefusedAndThePictureBeforeStays) {
  STAGE_OR_SKIP(stage, 320, 180);
  Scene scene{.color = makeYuvFrame(320, 180, {.name = ""}), .volume = kVolume};
  (void)stage.show(scene);
  scene.color = makePlane(100'000, 1, 8, 90);
  const auto shown = stage.tryShow(scene);
  ASSERT_FALSE(shown);
  EXPECT_EQ(shown.error().code, ErrorCode::Unsupported);
  EXPECT_NE(std::string(shown.error().message).find("larger than"), std::string::npos);
  expectBars(stage.again(), 3);
}

TEST(RenderFormats, WithWhatIsRefusedTheReliefAndTheOtherViewStayToo) {
  STAGE_OR_SKIP(stage, 640, 180);
  const Scene before{.color = makeYuvFrame(320, 180, {.name = ""}),
                     .depth = makePlane(4, 4, 8, 255),
                     .volume = kVolume,
                     .stereo = {.layout = StereoLayout::SideBySide},
                     .right = makePlane(320, 180, 8, 200)};
  const Image shown = stage.show(before);
  Scene refused = before;
  refused.depth = makePlane(4, 4, 8, 0);
  const Frame wide = makePlane(100'000, 1, 8, 90);
  for (const auto& [color, right] : {std::pair(wide, before.right), {makePlane(320, 180, 8, 20), wide}}) {
    refused.color = color;
    refused.right = right;
    refused.error_px *= 2;  // so that the triangles are made again
    EXPECT_FALSE(stage.tryShow(refused));
    EXPECT_LT(stage.again().meanDifference(shown), 0.01);
  }
}

TEST(RenderFormats, AThousandRenderersLeaveNoGlObject) {
  const ManualClock clock;
  const auto display = makeOffscreenDisplay({}, clock);
  if (!display->open({32, 32})) GTEST_SKIP() << "this machine has no EGL with GLES 3";
  const auto surface = display->beginFrame();
  ASSERT_TRUE(surface);
  // GL assigns names consecutively or reuses the lowest free one.
  const auto living = [] {
    std::array<int, 6> counts{};
    for (GLuint name = 1; name < 50'000; ++name) {
      counts[0] += glIsTexture(name);
      counts[1] += glIsBuffer(name);
      counts[2] += glIsVertexArray(name);
      counts[3] += glIsFramebuffer(name);
      counts[4] += glIsProgram(name);
      counts[5] += glIsShader(name);
    }
    return counts;
  };
  const auto before = living();
  for (int round = 0; round < 1000; ++round) {
    auto renderer = SceneRenderer::create(std::chrono::hours(1)).value();
    if (round % 20 != 0) continue;  // drawing takes longer
    const TextPicture dot{.x = 2, .y = 2, .width = 1, .height = 1, .cols = 1, .rows = 1, .rgba = {255, 255, 255, 255}};
    renderer->setText({.width = 64, .height = 36}, {dot});
    renderer->setSubtitles({.width = 64, .height = 36}, {dot});
    for (const auto layout : {StereoLayout::SideBySide, StereoLayout::Anaglyph}) {
      renderer->setStereo({.layout = layout});
      ASSERT_TRUE(renderer->setFrame(makeYuvFrame(64, 36, {.name = ""}), makePlane(64, 36, 8, 128), {}, kVolume));
      ASSERT_TRUE(renderer->draw(*surface, {FingerMark{.contact = true}}));
    }
  }
  glUseProgram(0);  // the one in use stays until another is
  EXPECT_EQ(living(), before);
}

TEST(RenderFormats, LargePictureIsAveragedNotSkipped) {
  // Columns of black and white, each a pixel wide, drawn two and a half times smaller: gray, where nearest-neighbour
  // sampling would give black and white bands.
  STAGE_OR_SKIP(stage, 320, 180);
  const auto stripes =
      makeRgbFrame(800, 450, [](int x, int) { return x % 2 == 0 ? Rgb{0, 0, 0} : Rgb{255, 255, 255}; });
  const Image image = stage.show({.color = stripes, .volume = kVolume});
  for (const int x : {10, 11, 12, 160, 161, 309}) expectColor(image, x, 90, {128, 128, 128}, 2);
}

TEST(RenderFormats, SizeAndFormatMayChangeFromFrameToFrame) {
  STAGE_OR_SKIP(stage, 320, 180);
  for (int round = 0; round < 3; ++round) {
    expectBars(stage.show({.color = makeYuvFrame(320, 180, {.name = ""}), .volume = kVolume}), 3);
    expectBars(stage.show({.color = makeYuvFrame(200, 100, {.name = "", .semi_planar = true}),
                           .depth = makePlane(20 + round, 10, 16, 32768),
                           .calibration = {.bits = 16},
                           .volume = kVolume}),
               3);
    const auto bars = [](int x, int) { return bar((x + 0.5) / 64); };
    expectBars(stage.show({.color = makeRgbFrame(64, 36, bars), .depth = makePlane(8, 8, 8, 128), .volume = kVolume}),
               2);
  }
}

TEST(RenderFormats, WhatCannotBeDrawnIsRefusedAndThePictureBeforeStays) {
  STAGE_OR_SKIP(stage, 320, 180);
  const Scene good{.color = makeYuvFrame(320, 180, {.name = ""}), .volume = kVolume};
  const Image before = stage.show(good);
  const auto white = makeRgbFrame(32, 18, [](int, int) { return Rgb{255, 255, 255}; });

  Frame five_bits = white;
  for (Component& component : five_bits.components) component.bits = 5;
  EXPECT_EQ(refusal(stage, {.color = five_bits, .volume = kVolume}), ErrorCode::Unsupported);

  EXPECT_EQ(refusal(stage, {.color = Frame{}, .volume = kVolume}), ErrorCode::InvalidArgument);
  // Hue needs colours: the haptic side rejects gray as well.
  EXPECT_EQ(refusal(stage, {.color = white,
                            .depth = makePlane(32, 18, 8, 1),
                            .calibration = {.code = DepthCode::Hue},
                            .volume = kVolume}),
            ErrorCode::Unsupported);

  EXPECT_EQ(stage.again().meanDifference(before), 0.0);
}

TEST(RenderFormats, BlackUntilAFrameIsSet) {
  STAGE_OR_SKIP(stage, 64, 36);
  const Image image = stage.again();
  EXPECT_EQ(image.at(32, 18), (Rgb{0, 0, 0}));
  EXPECT_EQ(image.channel(32, 18, 3), 255);
  EXPECT_EQ(stage.renderer().statistics().frames, 1u);
}

TEST(RenderFormats, SurfaceStaysOpaque) {
  STAGE_OR_SKIP(stage, 64, 36);
  const auto dark = makeRgbFrame(8, 8, [](int, int) { return Rgb{10, 10, 10}; }, {.step = 4});
  for (const StereoLayout layout : {StereoLayout::Mono, StereoLayout::SideBySide, StereoLayout::Anaglyph}) {
    Scene scene{.color = dark, .volume = kVolume, .stereo = {.layout = layout}};
    scene.finger = FingerMark{{0, 0, 10}, {0, 1, 0}, true};
    const Image image = stage.show(scene);
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 64; ++x) ASSERT_EQ(image.channel(x, y, 3), 255) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace relievo::test
