// SPDX-License-Identifier: Apache-2.0
// The sensor's faults: as many and as large as the model says.
#include <gtest/gtest.h>

#include <cmath>

#include "app/lab/film/sensor_depth.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr int kCols = 400, kRows = 300;

int codeAt(const Frame& frame, int c, int r) {
  return frame.planes[0].data[r * frame.planes[0].stride_bytes + c];
}

// Level 30 to the right of column 200, level 180 to the left.
Frame exactStep() {
  return test::makeGrayFrame(kCols, kRows, 16, MediaTime{}, [](int c, int) { return 257 * (c < 200 ? 180 : 30); });
}

TEST(LabSensorDepth, AddsNoiseOfItsDeviationAndNothingElse) {
  for (const double sigma : {1.0, 4.0}) {
    const Frame seen = sensedDepth(exactStep(), {.noise_levels = sigma, .faults = false}, 1);
    double sum = 0, squares = 0;
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kCols; ++c) {
        const double off = codeAt(seen, c, r) - (c < 200 ? 180 : 30);
        sum += off;
        squares += off * off;
        EXPECT_LT(std::abs(off), 6 * sigma);
      }
    }
    EXPECT_NEAR(sum / (kCols * kRows), 0, 0.02 * sigma);
    EXPECT_NEAR(squares / (kCols * kRows), sigma * sigma + 1.0 / 12, 0.03 * sigma * sigma);  // and rounding
  }
}

TEST(LabSensorDepth, MakesSaltHolesAndFlyingSamples) {
  const Frame seen = sensedDepth(exactStep(), {.noise_levels = 0, .faults = true}, 1);
  int holes = 0, salt = 0, flying = 0;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      const int code = codeAt(seen, c, r), exact = c < 200 ? 180 : 30;
      const bool beside = c == 199 || c == 200;
      holes += code == 0 ? 1 : 0;
      salt += code != 0 && code != exact && !beside ? 1 : 0;
      flying += code != 0 && code != exact && beside ? 1 : 0;
    }
  }
  EXPECT_NEAR(holes, kCols * kRows / 100, 100);
  EXPECT_NEAR(salt, kCols * kRows / 500, 60);
  EXPECT_NEAR(flying, 2 * kRows / 2, 60);
}

TEST(LabSensorDepth, TheSameSeedIsTheSamePicture) {
  const auto codes = [](std::uint64_t seed) {
    const Frame seen = sensedDepth(exactStep(), {.noise_levels = 2, .faults = true}, seed);
    return std::vector<std::uint8_t>(seen.planes[0].data, seen.planes[0].data + kCols * kRows);
  };
  EXPECT_EQ(codes(4), codes(4));
  EXPECT_NE(codes(4), codes(5));
}

// 128/257 = 0.498 is 1, as 0 is a hole; 386/257 = 1.502.
TEST(LabSensorDepth, RoundsToEightBitsAndKeepsHoles) {
  const int wide[] = {0, 1, 128, 386, 65535};
  const Frame frame = test::makeGrayFrame(5, 1, 16, MediaTime{}, [&](int c, int) { return wide[c]; });
  const Frame eight = asEightBits(frame);
  const int expected[] = {0, 1, 1, 2, 255};
  for (int c = 0; c < 5; ++c) EXPECT_EQ(codeAt(eight, c, 0), expected[c]);
}

}  // namespace
}  // namespace relievo
