// SPDX-License-Identifier: Apache-2.0
// The mean height of a block of samples.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "app/scene/height_field.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/scene/code_height.h"

namespace relievo {
namespace {

using test::kVolume;

TEST(HeightField, TheMeanOfABlockIsThatOfItsReadings) {
  // 8 and 16 bits, either polarity, a clamped range, the inverse law, holes: the fast path over codes against the
  // general one. If the picture has more bits than the depth, or fewer, the range is clamped at one end only.
  const std::pair<int, DepthCalibration> meanings[] = {{8, {}},
                                                       {16, {.bits = 16}},
                                                       {8, {.polarity = DepthPolarity::NearIsLow}},
                                                       {8, {.range = ColorRange::Limited}},
                                                       {10, {.bits = 8}},
                                                       {10, {.range = ColorRange::Limited, .bits = 12}},
                                                       {8, {.law = DepthLaw::Inverse, .near_mm = 500, .far_mm = 1000}},
                                                       {8, {.invalid = 9}}};
  for (const auto& [bits, meaning] : meanings) {
    const int top = bits > 8 ? 1019 : 251;
    const Frame frame = test::makeGrayFrame(20, 15, bits, {}, [&](int c, int r) { return (c * 137 + r * 401) % top; });
    const auto field = HeightField::make(frame, meaning, kVolume).value();
    for (const auto& [c0, r0, width, height] : {std::tuple(0, 0, 5, 5), {3, 7, 4, 2}, {15, 10, 5, 5}, {19, 14, 1, 1}}) {
      double sum = 0;
      int count = 0;
      for (int r = r0; r < r0 + height; ++r) {
        for (int c = c0; c < c0 + width; ++c) {
          const double z = field.heightMm(c, r);
          if (std::isnan(z)) continue;
          sum += z;
          ++count;
        }
      }
      EXPECT_NEAR(field.meanHeight(c0, r0, {width, height, 5}), sum / count, 1e-9) << bits << ' ' << c0;
    }
  }
}

TEST(HeightField, TheMeanOfAWideBlockIsReadAtAFewPlacesWithTheSameMarginsAllAround) {
  // On a slope only centred sampling gives the height of the middle.
  for (const int bits : {8, 16}) {
    const int top = (1 << bits) - 1, begin = top / 25, right = top / 85, down = top / 255;
    const Frame frame =
        test::makeGrayFrame(40, 40, bits, {}, [&](int c, int r) { return begin + right * c + down * r; });
    const auto field = HeightField::make(frame, {.bits = bits}, kVolume).value();
    for (int width = 1; width <= 33; ++width) {
      for (int most = 1; most <= 7; ++most) {
        const int height = 34 - width;
        const double middle = 40 * (begin + right * (2 + 0.5 * (width - 1)) + down * (1 + 0.5 * (height - 1))) / top;
        ASSERT_NEAR(field.meanHeight(2, 1, {width, height, most}), middle, 1e-9) << bits << ' ' << width << ' ' << most;
      }
    }
  }
}

// Of a block of plain codes whole rows are read, several samples at a time.
TEST(HeightField, TheMeanOfWholeRowsIsThatOfTheirSamples) {
  for (const int bits : {8, 10, 16}) {
    const int top = 1 << bits;
    const Frame frame =
        test::makeGrayFrame(320, 40, bits, {}, [&](int c, int r) { return (c * 7919 + r * 104729 + c * r) % top; });
    const auto field = HeightField::make(frame, {.bits = bits}, kVolume).value();
    for (const int width : {4, 5, 7, 8, 9, 14, 15, 16, 23, 63, 255, 256, 257, 263, 264, 300}) {
      const SampledBlock block = field.blockOf(width, 36, 3);
      EXPECT_EQ(block.across.count, width);
      double sum = 0;
      for (int k = 0; k < block.down.count; ++k) {
        const int r = 2 + block.down.first + k * block.down.step;
        for (int c = 11; c < 11 + width; ++c) sum += field.heightMm(c, r);
      }
      EXPECT_NEAR(field.meanHeight(11, 2, block), sum / (width * block.down.count), 1e-9) << bits << ' ' << width;
    }
  }
}

TEST(HeightField, TheMeanOfAWhiteBlockOfAnySizeIsTheTop) {
  for (const int bits : {8, 16}) {
    const int top = (1 << bits) - 1;
    const Frame frame = test::makeGrayFrame(2200, 29, bits, {}, [&](int, int) { return top; });
    const auto field = HeightField::make(frame, {.bits = bits}, kVolume).value();
    for (const int width : {8, 12, 15, 16, 31, 1023, 1025, 2047, 2199}) {
      for (const int rows : {1, 7, 29}) {
        const SampledBlock block(width, rows, 5000);
        EXPECT_NEAR(field.meanHeight(1, 0, block), kVolume.depth_mm, 1e-9) << bits << ' ' << width << ' ' << rows;
      }
    }
  }
}

TEST(SampledBlock, ReachesOverMostOfItsLength) {
  for (int length = 1; length <= 200; ++length) {
    for (int most = 2; most <= 15; ++most) {
      const SampledBlock::Places places(length, most);
      EXPECT_GE(2 * (places.step * (places.count - 1) + 1), length) << length << ' ' << most;
      EXPECT_EQ(2 * places.first + places.step * (places.count - 1), length - 1) << length << ' ' << most;
    }
  }
}

TEST(HeightField, ABlockWithReadingsInLessThanHalfOfItIsAHole) {
  const auto mean = [](int holes) {
    const Frame frame = test::makeGrayFrame(4, 4, 8, {}, [&](int c, int r) { return 4 * r + c < holes ? 0 : 51; });
    return HeightField::make(frame, {.invalid = 0}, kVolume).value().meanHeight(0, 0, {4, 4, 4});
  };
  EXPECT_DOUBLE_EQ(mean(0), 8);
  EXPECT_DOUBLE_EQ(mean(8), 8);
  EXPECT_TRUE(std::isnan(mean(9)));
}

// Words whose sample lies above other bits (P010), or below them: the mean of a block is that of its samples.
TEST(HeightField, TheMeanOfABlockOfTenBitsIsThatOfTheSamplesWhereverTheyLieInTheirWords) {
  for (const int shift : {0, 6}) {
    std::vector<std::uint16_t> words;
    double sum = 0;
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned code = 37 * k, beside = shift == 0 ? 0xfc00U : 0x2aU;
      words.push_back(static_cast<std::uint16_t>(code << shift | beside));
      sum += 40.0 * code / 1023;
    }
    Frame frame;
    frame.width = frame.height = 4;
    frame.components[0] = {.step_bytes = 2, .shift = static_cast<std::uint8_t>(shift), .bits = 10};
    frame.planes[0] = {reinterpret_cast<const std::uint8_t*>(words.data()), 8};
    const auto field = HeightField::make(frame, {.bits = 10}, kVolume).value();
    EXPECT_NEAR(field.meanHeight(0, 0, {4, 4, 4}), sum / 16, 1e-9) << shift;
  }
}

}  // namespace
}  // namespace relievo
