// SPDX-License-Identifier: Apache-2.0
// Every pixel format that a decoder may give is drawn in the colours that were meant.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "platform/unique_fd.h"
#include "tests/golden/picture_stage.h"
#include "tests/golden/yuv_frames.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {
namespace {

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

// Two luma samples share a pair of chroma samples, as webcams deliver them.
TEST(RenderFormats, Packed422IsReadByItsOffsets) {
  STAGE_OR_SKIP(stage, 320, 180);
  const Frame planar = makeYuvFrame(320, 180, {.name = "", .chroma_y = 0});
  struct Layout {
    const char* name;
    std::array<std::uint8_t, 3> offsets;
  };
  for (const Layout& layout : {Layout{"yuyv", {0, 1, 3}}, Layout{"uyvy", {1, 0, 2}}, Layout{"yvyu", {0, 3, 1}}}) {
    SCOPED_TRACE(layout.name);
    Frame frame = planar;
    auto bytes = std::make_shared<std::vector<std::uint8_t>>(std::size_t{640} * 180);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t step = c == 0 ? 2 : 4;
      for (std::size_t i = 0; i < bytes->size() / step; ++i) {
        const Plane& plane = planar.planes[planar.components[c].plane];
        const std::size_t cols = 640 / step;
        (*bytes)[i * step + layout.offsets[c]] = plane.data[static_cast<std::ptrdiff_t>(i / cols) * plane.stride_bytes +
                                                            static_cast<std::ptrdiff_t>(i % cols)];
      }
      frame.components[c] = {.offset_bytes = layout.offsets[c], .step_bytes = static_cast<std::uint8_t>(step)};
    }
    frame.planes[0] = {bytes->data(), 640};
    frame.plane_count = 1;
    frame.owner = bytes;
    expectBars(stage.show({.color = frame, .volume = kVolume}), 3);
  }
}

TEST(RenderFormats, GrayBesideAlphaIsGray) {
  STAGE_OR_SKIP(stage, 320, 180);
  Frame gray = makePlane(64, 18, 8, 126);
  gray.width = 32;
  gray.components[0].step_bytes = 2;
  expectColor(stage.show({.color = gray, .volume = kVolume}), 160, 90, {126, 126, 126}, 1);
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

}  // namespace
}  // namespace relievo::test
