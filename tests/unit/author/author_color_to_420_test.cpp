// SPDX-License-Identifier: Apache-2.0
// Colour of any layout as 8-bit 4:2:0; numbers from the standards' own definitions.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "app/author/package/color_to_420.h"

namespace relievo {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A planar picture of 8 or more bits, two bytes a sample above 8.
struct Planar {
  std::array<Bytes, 3> planes;
  Frame frame;

  Planar(int width, int height, int shift_x, int shift_y, int bits, const std::array<std::vector<int>, 3>& samples) {
    frame.width = width;
    frame.height = height;
    frame.model = ColorModel::Yuv;
    frame.range = ColorRange::Limited;
    frame.matrix = ColorMatrix::Bt601;
    frame.chroma_shift_x = static_cast<std::uint8_t>(shift_x);
    frame.chroma_shift_y = static_cast<std::uint8_t>(shift_y);
    frame.plane_count = 3;
    const int bytes = bits > 8 ? 2 : 1;
    for (std::size_t i = 0; i < 3; ++i) {
      for (const int sample : samples[i]) {
        planes[i].push_back(static_cast<std::uint8_t>(sample & 0xff));
        if (bytes == 2) planes[i].push_back(static_cast<std::uint8_t>(sample >> 8));
      }
      const int columns = i == 0 ? width : (width + (1 << shift_x) - 1) >> shift_x;
      frame.planes[i] = {planes[i].data(), std::ptrdiff_t{columns} * bytes};
      frame.components[i] = {.plane = static_cast<std::uint8_t>(i),
                             .step_bytes = static_cast<std::uint8_t>(bytes),
                             .bits = static_cast<std::uint8_t>(bits)};
    }
  }
};

ColorPicture420 converted(const Frame& frame) {
  ColorPicture420 picture;
  EXPECT_TRUE(toColor420(frame, picture).has_value());
  return picture;
}

TEST(AuthorColorTo420, LeavesEightBit420AsItIs) {
  const Planar film(4, 2, 1, 1, 8, {{{16, 17, 18, 19, 235, 254, 1, 0}, {100, 101}, {200, 201}}});
  const ColorPicture420 picture = converted(film.frame);
  EXPECT_EQ(picture.y, film.planes[0]);
  EXPECT_EQ(picture.u, film.planes[1]);
  EXPECT_EQ(picture.v, film.planes[2]);
  EXPECT_EQ(picture.range, ColorRange::Limited);
  EXPECT_EQ(picture.matrix, ColorMatrix::Bt601);
}

TEST(AuthorColorTo420, AveragesTheChromaOf444) {
  // (10 + 20 + 30 + 41)/4 = 25.25; (1 + 2 + 3 + 4)/4 = 2.5, rounded up.
  const Planar film(2, 2, 0, 0, 8, {{{50, 60, 70, 80}, {10, 20, 30, 41}, {1, 2, 3, 4}}});
  const ColorPicture420 picture = converted(film.frame);
  EXPECT_EQ(picture.y, (Bytes{50, 60, 70, 80}));
  EXPECT_EQ(picture.u, Bytes{25});
  EXPECT_EQ(picture.v, Bytes{3});
}

TEST(AuthorColorTo420, AveragesTheChromaOf422DownTheColumn) {
  const Planar film(4, 2, 1, 0, 8, {{{0, 0, 0, 0, 0, 0, 0, 0}, {10, 100, 20, 200}, {0, 0, 255, 255}}});
  const ColorPicture420 picture = converted(film.frame);
  EXPECT_EQ(picture.u, (Bytes{15, 150}));
  EXPECT_EQ(picture.v, (Bytes{128, 128}));  // 127.5, rounded up
}

TEST(AuthorColorTo420, RepeatsTheChromaOf410) {
  const Planar film(4, 4, 2, 2, 8, {{std::vector<int>(16, 90), {77}, {33}}});
  EXPECT_EQ(converted(film.frame).u, (Bytes{77, 77, 77, 77}));
}

TEST(AuthorColorTo420, RoundsTenBitsOfLimitedRangeByFour) {
  // 64 is black in 10 bits, 16 in 8; 66/4 = 16.5, rounded up; 1023/4 = 255.75 must fit in a byte.
  const Planar film(2, 2, 1, 1, 10, {{{64, 65, 66, 1023}, {512}, {514}}});
  const ColorPicture420 picture = converted(film.frame);
  EXPECT_EQ(picture.y, (Bytes{16, 16, 17, 255}));
  EXPECT_EQ(picture.u, Bytes{128});
  EXPECT_EQ(picture.v, Bytes{129});  // 128.5, rounded up
}

TEST(AuthorColorTo420, RescalesTenBitsOfFullRange) {
  Planar film(2, 2, 1, 1, 10, {{{0, 2, 511, 1023}, {512}, {512}}});
  film.frame.range = ColorRange::Full;
  const ColorPicture420 picture = converted(film.frame);
  EXPECT_EQ(picture.y, (Bytes{0, 0, 127, 255}));  // 255 c/1023: 0.499, 127.4
  EXPECT_EQ(picture.range, ColorRange::Full);
}

// BT.709: black 16, white 235; red Y' = 16 + 219 x 0.2126 = 62.6, Cb = 128 - 224 x 0.2126/1.8556 = 102.3, Cr = 240;
// green 172.6, 41.7, 26.4 (128 - 224 x 0.7152/1.5748 = 26.3); blue 31.8, 240, 117.7.
TEST(AuthorColorTo420, ConvertsRgbByBt709) {
  struct Case {
    std::array<std::uint8_t, 3> rgb;
    std::array<int, 3> yuv;
  };
  for (const Case& c :
       {Case{{0, 0, 0}, {16, 128, 128}}, Case{{255, 255, 255}, {235, 128, 128}}, Case{{255, 0, 0}, {63, 102, 240}},
        Case{{0, 255, 0}, {173, 42, 26}}, Case{{0, 0, 255}, {32, 240, 118}}, Case{{128, 128, 128}, {126, 128, 128}}}) {
    Bytes pixels;
    for (int i = 0; i < 4; ++i) pixels.insert(pixels.end(), c.rgb.begin(), c.rgb.end());
    Frame frame;
    frame.width = frame.height = 2;
    frame.model = ColorModel::Rgb;
    frame.range = ColorRange::Full;
    frame.plane_count = 1;
    frame.planes[0] = {pixels.data(), 6};
    for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.plane = 0, .offset_bytes = i, .step_bytes = 3};
    const ColorPicture420 picture = converted(frame);
    for (const std::uint8_t y : picture.y) EXPECT_EQ(y, c.yuv[0]);
    EXPECT_EQ(picture.u.at(0), c.yuv[1]);
    EXPECT_EQ(picture.v.at(0), c.yuv[2]);
    EXPECT_EQ(picture.range, ColorRange::Limited);
    EXPECT_EQ(picture.matrix, ColorMatrix::Bt709);
  }
}

TEST(AuthorColorTo420, GivesGrayNoColour) {
  Planar film(2, 2, 0, 0, 8, {{{1, 2, 3, 4}, {}, {}}});
  film.frame.model = ColorModel::Gray;
  const ColorPicture420 picture = converted(film.frame);
  EXPECT_EQ(picture.y, (Bytes{1, 2, 3, 4}));
  EXPECT_EQ(picture.u, Bytes{128});
  EXPECT_EQ(picture.v, Bytes{128});
}

TEST(AuthorColorTo420, RefusesAnOddSize) {
  const Planar film(3, 2, 1, 1, 8, {{{0, 0, 0, 0, 0, 0}, {0, 0}, {0, 0}}});
  ColorPicture420 picture;
  const auto result = toColor420(film.frame, picture);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace relievo
