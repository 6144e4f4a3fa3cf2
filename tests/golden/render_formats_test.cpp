// SPDX-License-Identifier: Apache-2.0
// Every pixel format shows the same colours, whatever its planes, strides and sizes; unsupported ones are reported.
#include <GLES3/gl3.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "drivers/egl/egl.h"
#include "platform/unique_fd.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {
namespace {

constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};

// Eight bars from left to right: the corners of the colour cube, slightly inset.
Rgb bar(double fraction) {
  const int i = std::min(static_cast<int>(fraction * 8), 7);
  return {(i & 4) != 0 ? 240 : 20, (i & 2) != 0 ? 230 : 30, (i & 1) != 0 ? 220 : 40};
}

// The standards' definition: E'Y = Kr R + Kg G + Kb B, E'Cb = (B - E'Y)/(2 (1 - Kb)), and the same for Cr.
std::array<double, 3> yuvOf(const Rgb& rgb, ColorMatrix matrix, bool limited, int bits) {
  const double kr = matrix == ColorMatrix::Bt601 ? 0.299 : matrix == ColorMatrix::Bt709 ? 0.2126 : 0.2627;
  const double kb = matrix == ColorMatrix::Bt601 ? 0.114 : matrix == ColorMatrix::Bt709 ? 0.0722 : 0.0593;
  const double r = rgb[0] / 255.0, g = rgb[1] / 255.0, b = rgb[2] / 255.0;
  const double y = kr * r + (1 - kr - kb) * g + kb * b;
  const double u = (b - y) / (2 * (1 - kb));
  const double v = (r - y) / (2 * (1 - kr));
  const double unit = std::pow(2.0, bits - 8);
  const double full = std::pow(2.0, bits) - 1;
  if (limited) return {(16 + 219 * y) * unit, (128 + 224 * u) * unit, (128 + 224 * v) * unit};
  return {full * y, 128 * unit + full * u, 128 * unit + full * v};
}

struct YuvFormat {
  const char* name;
  ColorMatrix matrix = ColorMatrix::Bt601;
  ColorRange range = ColorRange::Limited;
  int bits = 8;
  int shift = 0;
  int chroma_x = 1, chroma_y = 1;
  bool semi_planar = false;
  bool v_first = false;
  int padding = 0;  // bytes after each row
  bool upside_down = false;
};

// Bars of `width` x `height`, one memory plane after another; padding bytes have an arbitrary value.
Frame makeYuvFrame(int width, int height, const YuvFormat& format) {
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.model = ColorModel::Yuv;
  frame.range = format.range;
  frame.matrix = format.matrix;
  frame.chroma_shift_x = static_cast<std::uint8_t>(format.chroma_x);
  frame.chroma_shift_y = static_cast<std::uint8_t>(format.chroma_y);
  const int bytes = format.bits > 8 ? 2 : 1;
  const int chroma_width = (width + (1 << format.chroma_x) - 1) >> format.chroma_x;
  const int chroma_height = (height + (1 << format.chroma_y) - 1) >> format.chroma_y;
  auto owner = std::make_shared<std::vector<std::vector<std::uint8_t>>>();

  const auto addPlane = [&](int columns, int rows, int channels, auto&& value) {
    const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(columns) * channels * bytes + format.padding;
    auto& plane = owner->emplace_back(static_cast<std::size_t>(stride * rows), std::uint8_t{0xcd});
    for (int r = 0; r < rows; ++r) {
      std::uint8_t* out = plane.data() + stride * (format.upside_down ? rows - 1 - r : r);
      for (int i = 0; i < columns * channels; ++i) {
        const auto word = static_cast<unsigned>(std::lround(value(i / channels, i % channels))) << format.shift;
        *out++ = static_cast<std::uint8_t>(word & 0xff);
        if (bytes == 2) *out++ = static_cast<std::uint8_t>(word >> 8);
      }
    }
    frame.planes[frame.plane_count++] =
        format.upside_down ? Plane{plane.data() + stride * (rows - 1), -stride} : Plane{plane.data(), stride};
  };
  owner->reserve(3);
  const bool limited = format.range == ColorRange::Limited;
  const auto at = [&](double x, int component) {
    return yuvOf(bar(x), format.matrix, limited, format.bits)[static_cast<std::size_t>(component)];
  };
  const auto lumaAt = [&](int c) { return (c + 0.5) / width; };
  // The centre of the luma samples that share this chroma sample.
  const auto chromaAt = [&](int c) {
    const int first = c << format.chroma_x;
    return 0.5 * (first + std::min(first + (1 << format.chroma_x), width)) / width;
  };
  const auto component = [&](int plane, int offset, int step) {
    return Component{static_cast<std::uint8_t>(plane), static_cast<std::uint8_t>(offset * bytes),
                     static_cast<std::uint8_t>(step * bytes), static_cast<std::uint8_t>(format.shift),
                     static_cast<std::uint8_t>(format.bits)};
  };

  addPlane(width, height, 1, [&](int c, int) { return at(lumaAt(c), 0); });
  frame.components[0] = component(0, 0, 1);
  if (format.semi_planar) {
    addPlane(chroma_width, chroma_height, 2,
             [&](int c, int channel) { return at(chromaAt(c), (channel == 0) == format.v_first ? 2 : 1); });
    frame.components[1] = component(1, format.v_first ? 1 : 0, 2);
    frame.components[2] = component(1, format.v_first ? 0 : 1, 2);
  } else {
    for (int plane = 1; plane <= 2; ++plane) {
      addPlane(chroma_width, chroma_height, 1, [&](int c, int) { return at(chromaAt(c), plane); });
      frame.components[static_cast<std::size_t>(plane)] = component(plane, 0, 1);
    }
  }
  frame.owner = owner;
  return frame;
}

void expectColor(const Image& image, int x, int y, const Rgb& wanted, int tolerance) {
  const Rgb seen = image.at(x, y);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(seen[c], wanted[c], tolerance) << "channel " << c << " at " << x << ", " << y;
  }
}

// The middle of each bar, near the top and near the bottom.
void expectBars(const Image& image, int tolerance) {
  for (int i = 0; i < 8; ++i) {
    const double middle = (i + 0.5) / 8;
    const int x = static_cast<int>(middle * image.width);
    expectColor(image, x, 6, bar(middle), tolerance);
    expectColor(image, x, image.height - 7, bar(middle), tolerance);
  }
}

class YuvFormats : public testing::TestWithParam<YuvFormat> {};

TEST_P(YuvFormats, ShowTheColoursThatWereMeant) {
  STAGE_OR_SKIP(stage, 320, 180);
  expectBars(stage.show({.color = makeYuvFrame(320, 180, GetParam()), .volume = kVolume}), 3);
}

INSTANTIATE_TEST_SUITE_P(
    RenderFormats, YuvFormats,
    testing::Values(
        YuvFormat{.name = "i420"}, YuvFormat{.name = "i422", .chroma_y = 0},
        YuvFormat{.name = "i444", .chroma_x = 0, .chroma_y = 0},
        YuvFormat{.name = "full_range", .range = ColorRange::Full},
        YuvFormat{.name = "bt709", .matrix = ColorMatrix::Bt709},
        YuvFormat{.name = "bt2020", .matrix = ColorMatrix::Bt2020}, YuvFormat{.name = "nv12", .semi_planar = true},
        YuvFormat{.name = "nv21", .semi_planar = true, .v_first = true},
        YuvFormat{.name = "ten_bits", .matrix = ColorMatrix::Bt2020, .bits = 10},
        YuvFormat{.name = "p010", .bits = 10, .shift = 6, .semi_planar = true},
        YuvFormat{.name = "sixteen_bits", .range = ColorRange::Full, .bits = 16, .chroma_x = 0, .chroma_y = 0},
        YuvFormat{.name = "padded_to_words", .padding = 64}, YuvFormat{.name = "padded_by_three", .padding = 3},
        YuvFormat{.name = "nv12_padded_by_one", .semi_planar = true, .padding = 1},
        YuvFormat{.name = "upside_down", .padding = 5, .upside_down = true},
        YuvFormat{.name = "ten_bits_upside_down", .bits = 10, .padding = 6, .upside_down = true}),
    [](const auto& one) { return std::string(one.param.name); });

// A descriptor without memory, and memory that ends within the picture: not every driver refuses them.
TEST(RenderFormats, WhatTheDriverDoesNotImportIsUploaded) {
  const UniqueFd nothing(open("/dev/null", O_RDONLY | O_CLOEXEC)), half(memfd_create("half a picture", MFD_CLOEXEC));
  ASSERT_EQ(ftruncate(half.get(), 320 * 90), 0);
  for (const YuvFormat& format : {YuvFormat{.name = "i420"}, YuvFormat{.name = "nv12", .semi_planar = true}}) {
    for (const int fd : {nothing.get(), half.get()}) {
      STAGE_OR_SKIP(stage, 320, 180);  // a renderer asks no more after a refusal
      Frame frame = makeYuvFrame(320, 180, format);
      for (DmaBuf& each : frame.dma_bufs) each = {.fd = fd};
      expectBars(stage.show({.color = frame, .volume = kVolume}), 3);
      EXPECT_FALSE(stage.renderer().statistics().imported);
    }
  }
}

TEST(RenderFormats, UpsideDownRowsAreTurned) {
  // Bars run down the columns; this one has a dark half below.
  STAGE_OR_SKIP(stage, 320, 180);
  const auto half = [](int, int y) { return y < 9 ? Rgb{200, 180, 160} : Rgb{10, 20, 30}; };
  for (const bool upside_down : {false, true}) {
    const Frame frame = makeRgbFrame(32, 18, half, {.padding = 2, .upside_down = upside_down});
    const Image image = stage.show({.color = frame, .volume = kVolume});
    expectColor(image, 160, 45, {200, 180, 160}, 1);
    expectColor(image, 160, 135, {10, 20, 30}, 1);
  }
}

TEST(RenderFormats, PackedRgbIsReadByItsOffsets) {
  STAGE_OR_SKIP(stage, 320, 180);
  const auto bars = [](int x, int) { return bar((x + 0.5) / 320); };
  for (const PackedLayout& layout :
       {PackedLayout{}, PackedLayout{.offsets = {2, 1, 0}}, PackedLayout{.step = 4},
        PackedLayout{.step = 4, .offsets = {2, 1, 0}}, PackedLayout{.step = 4, .offsets = {1, 2, 3}},
        PackedLayout{.padding = 5}, PackedLayout{.step = 4, .padding = 3}}) {
    SCOPED_TRACE(testing::Message() << "step " << layout.step << ", red at " << layout.offsets[0] << ", padding "
                                    << layout.padding);
    expectBars(stage.show({.color = makeRgbFrame(320, 180, bars, layout), .volume = kVolume}), 1);
  }
}

TEST(RenderFormats, PlanarRgbIsReadByItsPlanes) {
  // The order of FFmpeg's gbrp: green, blue, red.
  STAGE_OR_SKIP(stage, 320, 180);
  Frame frame = makeYuvFrame(320, 180, {.name = "", .chroma_x = 0, .chroma_y = 0});
  constexpr std::size_t kPixels = std::size_t{320} * 180;
  auto planes = std::make_shared<std::vector<std::uint8_t>>(3 * kPixels);
  constexpr std::array<std::size_t, 3> kChannel{1, 2, 0};
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t i = 0; i < kPixels; ++i) {
      (*planes)[p * kPixels + i] = static_cast<std::uint8_t>(bar((static_cast<int>(i % 320) + 0.5) / 320)[kChannel[p]]);
    }
    frame.planes[p] = {planes->data() + p * kPixels, 320};
    frame.components[kChannel[p]].plane = static_cast<std::uint8_t>(p);
  }
  frame.model = ColorModel::Rgb;
  frame.range = ColorRange::Unspecified;
  frame.owner = planes;
  expectBars(stage.show({.color = frame, .volume = kVolume}), 1);
}

TEST(RenderFormats, GrayIsGrayInItsRange) {
  STAGE_OR_SKIP(stage, 320, 180);
  Frame gray = makePlane(32, 18, 8, 126);
  expectColor(stage.show({.color = gray, .volume = kVolume}), 160, 90, {126, 126, 126}, 1);
  gray.range = ColorRange::Limited;  // (126 - 16)/219 of 255
  expectColor(stage.show({.color = gray, .volume = kVolume}), 160, 90, {128, 128, 128}, 1);
  gray = makePlane(32, 18, 16, 126 * 256 + 200);
  expectColor(stage.show({.color = gray, .volume = kVolume}), 160, 90, {126, 126, 126}, 1);
}

TEST(RenderFormats, WhatTheStreamDoesNotSayIsTakenAsPlayersDo) {
  // Red of BT.601, limited, unsignalled: correct at 480 lines. At 720 lines unsignalled means BT.709.
  STAGE_OR_SKIP(stage, 320, 180);
  YuvFormat format{.name = ""};
  Frame small = makeYuvFrame(320, 480, format);
  format.matrix = ColorMatrix::Bt709;
  Frame large = makeYuvFrame(320, 720, format);
  for (Frame* frame : {&small, &large}) {
    frame->matrix = ColorMatrix::Unspecified;
    frame->range = ColorRange::Unspecified;
    expectBars(stage.show({.color = *frame, .volume = kVolume}), 3);
  }
}

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

ErrorCode refusal(Stage& stage, const Scene& scene) {
  const auto shown = stage.tryShow(scene);
  EXPECT_FALSE(shown);
  if (shown) return {};
  EXPECT_STRNE(shown.error().message, "");
  return shown.error().code;
}

TEST(RenderFormats, WhatCannotBeDrawnIsRefusedAndThePictureBeforeStays) {
  STAGE_OR_SKIP(stage, 320, 180);
  const Scene good{.color = makeYuvFrame(320, 180, {.name = ""}), .volume = kVolume};
  const Image before = stage.show(good);
  const auto white = makeRgbFrame(32, 18, [](int, int) { return Rgb{255, 255, 255}; });

  Frame five_bits = white;
  for (Component& component : five_bits.components) component.bits = 5;
  EXPECT_EQ(refusal(stage, {.color = five_bits, .volume = kVolume}), ErrorCode::Unsupported);

  Frame yuyv = makePlane(64, 18, 8, 128);
  yuyv.model = ColorModel::Yuv;
  yuyv.width = 32;
  yuyv.chroma_shift_x = 1;
  yuyv.components = {Component{0, 0, 2}, Component{0, 1, 4}, Component{0, 3, 4}};
  EXPECT_EQ(refusal(stage, {.color = yuyv, .volume = kVolume}), ErrorCode::Unsupported);

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
