// SPDX-License-Identifier: Apache-2.0
// Interlaced pictures made whole, sample by sample.
#include "app/media/tracks/deinterlaced.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using test::sampleAt;

// An edge at column 4 in even rows and at column 8 in odd ones: it has moved between the fields.
TEST(Deinterlaced, AMovingEdgeIsOneLineWithTheValuesThatItHad) {
  constexpr int kCols = 12, kRows = 7;
  std::vector<std::uint16_t> codes(kCols * kRows);
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) codes[static_cast<std::size_t>(r * kCols + c)] = c < (r % 2 == 0 ? 4 : 8) ? 0 : 900;
  }
  Frame frame = grayFrame(std::make_shared<const std::vector<std::uint16_t>>(codes), kCols, kRows);
  frame.interlaced = true;
  for (const bool top : {true, false}) {
    frame.top_field_first = top;
    const Frame whole = deinterlaced(frame).value();
    EXPECT_FALSE(whole.interlaced);
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kCols; ++c) {
        EXPECT_EQ(sampleAt(whole, 0, c, r), c < (top ? 4 : 8) ? 0u : 900u) << c << " " << r;
      }
    }
  }
}

TEST(Deinterlaced, AStillSlopeAndItsChromaAreKept) {
  constexpr int kCols = 8, kRows = 12;
  std::vector<std::uint8_t> luma(kCols * kRows), chroma(2 * 4 * 6);
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c)
      luma[static_cast<std::size_t>(r * kCols + c)] = static_cast<std::uint8_t>(10 * r + c);
  }
  for (std::size_t i = 0; i < chroma.size(); ++i) chroma[i] = static_cast<std::uint8_t>(100 + i);
  chroma[8] = 250;  // U of the second row, which the field of odd rows alone holds
  Frame frame;
  frame.width = kCols, frame.height = kRows;
  frame.model = ColorModel::Yuv;
  frame.interlaced = true;
  frame.chroma_shift_x = frame.chroma_shift_y = 1;
  frame.plane_count = 2;
  frame.planes[0] = {luma.data(), kCols};
  frame.planes[1] = {chroma.data(), 8};
  frame.components[1] = {.plane = 1, .step_bytes = 2};
  frame.components[2] = {.plane = 1, .offset_bytes = 1, .step_bytes = 2};
  const Frame whole = deinterlaced(frame).value();
  for (int r = 0; r < kRows - 1; ++r) {  // below the last row there is no field
    for (int c = 0; c < kCols; ++c) EXPECT_EQ(sampleAt(whole, 0, c, r), static_cast<unsigned>(10 * r + c));
  }
  EXPECT_EQ(sampleAt(whole, 1, 0, 1), 116u) << "the median of 100, 250 and 116";
  EXPECT_EQ(sampleAt(whole, 2, 0, 1), 109u);
}

TEST(Deinterlaced, PicturesOfOneRowAndOfNegativeStride) {
  std::vector<std::uint8_t> bytes{1, 2, 3, 4, 5, 6, 7, 8, 9};
  Frame frame;
  frame.width = 3, frame.height = 3;
  frame.plane_count = 1;
  frame.planes[0] = {bytes.data() + 6, -3};
  const Frame whole = deinterlaced(frame).value();
  EXPECT_EQ(sampleAt(whole, 0, 0, 0), 7u);
  EXPECT_EQ(sampleAt(whole, 0, 0, 2), 1u);
  frame.height = 1;
  EXPECT_EQ(sampleAt(deinterlaced(frame).value(), 0, 2, 0), 9u);
}

}  // namespace
}  // namespace relievo
