// SPDX-License-Identifier: Apache-2.0
// PSNR and SSIM of pictures whose figures follow on paper.
#include "app/lab/detail/picture_quality.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relievo {
namespace {

constexpr int kWidth = 32, kHeight = 24;
constexpr double kC1 = 6.5025, kC2 = 58.5225;  // (0.01 x 255)^2, (0.03 x 255)^2

template <class Gray>
DrawnPicture grayPicture(Gray&& gray) {
  DrawnPicture picture{kWidth, kHeight, {}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto value = static_cast<std::uint8_t>(gray(x, y));
      picture.rgba.insert(picture.rgba.end(), {value, value, value, 255});
    }
  }
  return picture;
}
DrawnPicture flat(int gray) {
  return grayPicture([gray](int, int) { return gray; });
}
// Every second pixel is above and every other one as far below 128. In the window its mean is 128 and its variance
// amplitude^2 to eight digits: the window's weights with alternating signs sum up to 1e-4, in two directions to 1e-8.
DrawnPicture checkers(int amplitude) {
  return grayPicture([amplitude](int x, int y) { return 128 + ((x + y) % 2 == 0 ? amplitude : -amplitude); });
}

PictureError errorOf(const DrawnPicture& picture, const DrawnPicture& reference) {
  PictureError error;
  error.add(differenceOf(picture, reference), std::vector<std::uint8_t>(reference.rgba.size() / 4, 1));
  return error;
}

TEST(PictureQuality, TheSamePictureIsWithoutError) {
  const DrawnPicture picture = grayPicture([](int x, int y) { return (x * 37 + y * 101) % 256; });
  const PictureError error = errorOf(picture, picture);
  EXPECT_TRUE(std::isinf(error.psnrDb()));
  EXPECT_NEAR(error.similarity(), 1, 1e-6);
}

TEST(PictureQuality, PsnrIsOfTheMeanSquareOfAllChannels) {
  EXPECT_NEAR(errorOf(flat(110), flat(100)).psnrDb(), 20 * std::log10(25.5), 1e-6);  // 28.13 dB
  DrawnPicture reddish = flat(100);
  for (std::size_t i = 0; i < reddish.rgba.size(); i += 4) reddish.rgba[i] = 110;  // a third of the mean square
  EXPECT_NEAR(errorOf(reddish, flat(100)).psnrDb(), 20 * std::log10(25.5) + 10 * std::log10(3.0), 1e-6);
  DrawnPicture clear = flat(100);
  for (std::size_t i = 3; i < clear.rgba.size(); i += 4) clear.rgba[i] = 0;
  EXPECT_TRUE(std::isinf(errorOf(clear, flat(100)).psnrDb()));
}

TEST(PictureQuality, SimilarityOfFlatPicturesIsThatOfTheirLuminance) {
  EXPECT_NEAR(errorOf(flat(100), flat(50)).similarity(), (2 * 100 * 50 + kC1) / (100 * 100 + 50 * 50 + kC1), 1e-3);
}

TEST(PictureQuality, SimilarityOfAFainterPatternIsThatOfItsContrast) {
  EXPECT_NEAR(errorOf(checkers(10), checkers(20)).similarity(), (2 * 10 * 20 + kC2) / (10 * 10 + 20 * 20 + kC2), 1e-3);
}

TEST(PictureQuality, SimilarityOfANegativeIsBelowZero) {
  DrawnPicture negative = checkers(40);
  for (std::uint8_t& value : negative.rgba) value = static_cast<std::uint8_t>(256 - value);
  EXPECT_NEAR(errorOf(negative, checkers(40)).similarity(), (-2 * 1600 + kC2) / (2 * 1600 + kC2), 1e-3);
}

// A spot of one pixel on a flat picture, 100 over it. Where the window's weight on it is w = g(dx) g(dy), mean and
// variance rise by 100 w and 100^2 (w - w^2): at the spot w = 0.26601^2, five to the side 0.26601 x 0.0010284.
TEST(PictureQuality, TheWindowIsTheGaussianThatWasPublished) {
  DrawnPicture spot = flat(100);
  const std::size_t at = 12 * kWidth + 16;
  for (std::size_t c = 0; c < 3; ++c) spot.rgba[4 * at + c] = 200;
  const PictureDifference difference = differenceOf(spot, flat(100));
  const auto expected = [](double w) {
    const double mean = 100 + 100 * w, variance = 1e4 * (w - w * w);
    return (2 * mean * 100 + kC1) / (mean * mean + 1e4 + kC1) * kC2 / (variance + kC2);
  };
  EXPECT_NEAR(difference.similarity[at], expected(0.26601 * 0.26601), 1e-3);
  EXPECT_NEAR(difference.similarity[at + 5], expected(0.26601 * 0.0010284), 1e-3);
  EXPECT_NEAR(difference.similarity[at + 6], 1, 1e-3);
  EXPECT_TRUE(std::isnan(difference.similarity[at - 12]));  // four from the picture's left side
}

TEST(PictureQuality, WhatIsNotCountedIsLeftOut) {
  DrawnPicture half = flat(100);
  std::vector<std::uint8_t> counted(half.rgba.size() / 4, 1);
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (i % kWidth < kWidth / 2) continue;
    half.rgba[4 * i] = half.rgba[4 * i + 1] = half.rgba[4 * i + 2] = 110;
  }
  for (std::size_t i = 0; i < counted.size(); ++i) counted[i] = i % kWidth < kWidth / 2 - 5 ? 1 : 0;
  PictureError left;
  left.add(differenceOf(half, flat(100)), counted);
  EXPECT_EQ(left.pixels(), static_cast<std::size_t>(kHeight) * (kWidth / 2 - 5));
  EXPECT_TRUE(std::isinf(left.psnrDb()));
  EXPECT_NEAR(left.similarity(), 1, 1e-6);
  EXPECT_NEAR(errorOf(half, flat(100)).psnrDb(), 20 * std::log10(25.5) + 10 * std::log10(2.0), 1e-6);
}

TEST(PictureQuality, AveragingDownTakesTheMeanOfEachChannel) {
  const DrawnPicture fine{4, 2, {0, 1, 2, 3, 4, 5, 6,  7,  100, 0, 0, 255, 100, 0, 0, 255,    // above
                                 8, 9, 9, 9, 8, 9, 10, 11, 100, 0, 0, 255, 103, 0, 0, 255}};  // below
  const DrawnPicture small = averagedDown(fine, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.rgba, (std::vector<std::uint8_t>{5, 6, 7, 8, 101, 0, 0, 255}));  // 20/4, 24/4, 27/4, 30/4; 403/4
}

}  // namespace
}  // namespace relievo
