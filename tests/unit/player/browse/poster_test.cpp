// SPDX-License-Identifier: Apache-2.0
// Posters of HDR films, against the signal levels of ITU-R BT.2408, table 1.
#include "app/player/browse/poster.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace relievo {
namespace {

constexpr std::uint8_t kPq = 16, kHlg = 18, kBt2020 = 9;

// One colour all over, of full range; `color` in shares of the range.
Frame frameOf(std::array<double, 3> color, std::uint8_t transfer) {
  auto samples = std::make_shared<std::vector<std::uint8_t>>();
  for (int pixel = 0; pixel < 16 * 9; ++pixel) {
    for (const double share : color) samples->push_back(static_cast<std::uint8_t>(std::lround(255 * share)));
  }
  Frame frame{.width = 16, .height = 9, .model = ColorModel::Rgb, .range = ColorRange::Full};
  frame.primaries = kBt2020;
  frame.transfer = transfer;
  frame.plane_count = 1;
  for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.offset_bytes = i, .step_bytes = 3};
  frame.planes[0] = {samples->data(), std::ptrdiff_t{3} * 16};
  frame.owner = samples;
  return frame;
}

std::array<int, 3> posterOfColor(std::array<double, 3> color, std::uint8_t transfer) {
  const TextPicture poster = posterOf(frameOf(color, transfer));
  EXPECT_EQ(poster.rgba.size(), std::size_t{4} * 192 * 108);
  return {poster.rgba[0], poster.rgba[1], poster.rgba[2]};
}

int grayOf(double share, std::uint8_t transfer) {
  const auto [red, green, blue] = posterOfColor({share, share, share}, transfer);
  EXPECT_NEAR(red, green, 1);
  EXPECT_NEAR(green, blue, 1);
  return red;
}

// 18 % gray is 26 cd/m2 of a white of 203: (26/203)^(1/2.4) of 255 = 108. Both transfers have it at 38 %.
TEST(Poster, HdrsGrayCardIsThatOfAUsualScreen) {
  EXPECT_NEAR(grayOf(0.38, kPq), 108, 3);
  EXPECT_NEAR(grayOf(0.38, kHlg), 108, 3);
}

// Reference white, 203 cd/m2, is 58 % of PQ and 75 % of HLG: bright, with room above it for 1000 cd/m2, which are 75 %
// of PQ and all of HLG.
TEST(Poster, HdrsWhiteIsBrightAndItsHighlightsAreWhite) {
  EXPECT_NEAR(grayOf(0.58, kPq), grayOf(0.75, kHlg), 3);
  EXPECT_GT(grayOf(0.58, kPq), 215);
  EXPECT_LT(grayOf(0.58, kPq), 245);
  EXPECT_NEAR(grayOf(0.7518, kPq), 255, 1);
  EXPECT_EQ(grayOf(1, kHlg), 255);
  EXPECT_EQ(grayOf(1, kPq), 255) << "10000 cd/m2";
  EXPECT_EQ(grayOf(0, kPq), 0);
}

// BT.709's red as BT.2020 stores it: 0.6274, 0.0691 and 0.0164 of 100 cd/m2, which PQ codes as 0.4621, 0.2713 and
// 0.1767 (ITU-R BT.2087; SMPTE ST 2084).
TEST(Poster, ColoursLoseNoSaturation) {
  const auto [red, green, blue] = posterOfColor({0.4621, 0.2713, 0.1767}, kPq);
  EXPECT_GT(red, 170);
  EXPECT_LT(green, 40);
  EXPECT_LT(blue, 40);
}

TEST(Poster, AnSdrFilmsColoursAreItsOwn) {
  EXPECT_EQ(posterOfColor({0.8, 0.4, 0.2}, kBt709), (std::array<int, 3>{204, 102, 51}));
}

}  // namespace
}  // namespace relievo
