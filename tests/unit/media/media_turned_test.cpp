// SPDX-License-Identifier: Apache-2.0
// Pictures turned by quarter turns, sample by sample.
#include <gtest/gtest.h>

#include <vector>

#include "app/media/tracks/turned.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using test::sampleAt;

// Position of sample (column, row) of a picture of `cols` x `rows` after a quarter turn clockwise.
std::pair<int, int> afterOne(int column, int row, int rows) {
  return {rows - 1 - row, column};
}

void expectTurned(const Frame& before, const Frame& after, int turns, int component, int cols, int rows) {
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      std::pair<int, int> at{c, r};
      for (int i = 0; i < turns; ++i) at = afterOne(at.first, at.second, i % 2 == 0 ? rows : cols);
      ASSERT_EQ(sampleAt(after, component, at.first, at.second), sampleAt(before, component, c, r))
          << turns << " turns, component " << component << ", " << c << " " << r;
    }
  }
}

TEST(Turned, GrayOfTwelveBitsInTwoBytesKeepsEverySample) {
  constexpr int kCols = 70, kRows = 37;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(kRows) * 160);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 37 + i / 160);
  Frame frame;
  frame.width = kCols, frame.height = kRows;
  frame.sample_aspect = 2;
  frame.plane_count = 1;
  frame.components[0] = {.plane = 0, .offset_bytes = 2, .step_bytes = 2, .shift = 4, .bits = 12};
  frame.planes[0] = {bytes.data(), 160};
  for (int turns = 1; turns <= 3; ++turns) {
    const Frame after = turned(frame, turns).value();
    EXPECT_EQ(after.width, turns == 2 ? kCols : kRows);
    EXPECT_EQ(after.height, turns == 2 ? kRows : kCols);
    EXPECT_EQ(after.sample_aspect, turns == 2 ? 2 : 0.5);
    expectTurned(frame, after, turns, 0, kCols, kRows);
  }
}

// Hue depth is read from pixels of 3 or 4 bytes, so BGRA stays packed.
TEST(Turned, PackedRgbStaysPacked) {
  constexpr int kCols = 5, kRows = 3;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(kCols) * 4 * kRows);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i + 1);
  Frame frame;
  frame.width = kCols, frame.height = kRows;
  frame.model = ColorModel::Rgb;
  frame.plane_count = 1;
  for (std::uint8_t i = 0; i < 3; ++i) {
    frame.components[i] = {.offset_bytes = static_cast<std::uint8_t>(2 - i), .step_bytes = 4};
  }
  frame.planes[0] = {bytes.data(), std::ptrdiff_t{4} * kCols};
  for (int turns = 1; turns <= 3; ++turns) {
    const Frame after = turned(frame, turns).value();
    EXPECT_EQ(after.plane_count, 1);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(after.components[static_cast<std::size_t>(i)].step_bytes, 4);
      expectTurned(frame, after, turns, i, kCols, kRows);
    }
  }
}

// YUYV: the three components share a plane, and two columns share their chroma.
TEST(Turned, PackedColourKeepsItsChroma) {
  constexpr int kCols = 6, kRows = 4;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(kCols) * 2 * kRows);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i + 1);
  Frame frame;
  frame.width = kCols, frame.height = kRows;
  frame.model = ColorModel::Yuv;
  frame.chroma_shift_x = 1;
  frame.plane_count = 1;
  frame.components = {Component{.offset_bytes = 0, .step_bytes = 2}, Component{.offset_bytes = 1, .step_bytes = 4},
                      Component{.offset_bytes = 3, .step_bytes = 4}};
  frame.planes[0] = {bytes.data() + bytes.size() - kCols * 2, -kCols * 2};  // stored upside down
  for (int turns = 1; turns <= 3; ++turns) {
    const Frame after = turned(frame, turns).value();
    EXPECT_EQ(after.chroma_shift_x, turns == 2 ? 1 : 0);
    EXPECT_EQ(after.chroma_shift_y, turns == 2 ? 0 : 1);
    expectTurned(frame, after, turns, 0, kCols, kRows);
    expectTurned(frame, after, turns, 1, kCols / 2, kRows);
    expectTurned(frame, after, turns, 2, kCols / 2, kRows);
  }
}

// An alpha channel, in a plane of its own or in the pixels, is turned and cropped as the rest is.
TEST(Turned, AlphaGoesAlong) {
  constexpr int kCols = 6, kRows = 4;
  std::vector<std::uint8_t> gray(kCols * kRows), alpha(kCols * kRows), pixels(4 * kCols * kRows);
  for (std::size_t i = 0; i < gray.size(); ++i) {
    gray[i] = static_cast<std::uint8_t>(i);
    alpha[i] = pixels[4 * i + 3] = static_cast<std::uint8_t>(100 + i);
  }
  Frame own;
  own.width = kCols, own.height = kRows;
  own.plane_count = 2;
  own.planes = {Plane{gray.data(), kCols}, Plane{alpha.data(), kCols}};
  own.alpha = Component{.plane = 1};
  Frame packed;
  packed.width = kCols, packed.height = kRows;
  packed.model = ColorModel::Rgb;
  packed.plane_count = 1;
  packed.planes[0] = {pixels.data(), 4 * kCols};
  for (std::uint8_t i = 0; i < 3; ++i) packed.components[i] = {.offset_bytes = i, .step_bytes = 4};
  packed.alpha = Component{.offset_bytes = 3, .step_bytes = 4};
  const auto alphaAt = [](const Frame& f, int c, int r) {
    const Plane& plane = f.planes[f.alpha->plane];
    return *(plane.data + r * plane.stride_bytes + f.alpha->offset_bytes + c * f.alpha->step_bytes);
  };
  for (const Frame* frame : {&own, &packed}) {
    const Frame upright = turned(*frame, 1).value();
    const Frame part = crop(*frame, 2, 1, 3, 2);
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kCols; ++c)
        ASSERT_EQ(alphaAt(upright, kRows - 1 - r, c), 100 + r * kCols + c) << c << " " << r;
    }
    EXPECT_EQ(alphaAt(part, 1, 1), 100 + 2 * kCols + 3);
  }
}

}  // namespace
}  // namespace relievo
