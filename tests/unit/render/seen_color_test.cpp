// SPDX-License-Identifier: Apache-2.0
// The picture that is uploaded against the mean of its samples, each taken by itself in floating point.
#include "app/render/gl/seen_color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

namespace relievo {
namespace {

struct Case {
  int width, height;
  int chroma_x, chroma_y;  // shifts
  int across, down;        // samples per pixel
  int bits = 8;
  bool pairs = false;  // U and V in one plane
};

// Three planes of noise.
struct Noise {
  explicit Noise(const Case& how) {
    std::mt19937 random(5);
    frame.width = how.width;
    frame.height = how.height;
    frame.model = ColorModel::Yuv;
    frame.chroma_shift_x = static_cast<std::uint8_t>(how.chroma_x);
    frame.chroma_shift_y = static_cast<std::uint8_t>(how.chroma_y);
    const int bytes = how.bits > 8 ? 2 : 1;
    for (std::uint8_t i = 0; i < 3; ++i) {
      const int channels = how.pairs && i > 0 ? 2 : 1;
      const int cols = colsOf(i) * channels;
      const std::uint8_t plane = how.pairs ? std::min<std::uint8_t>(i, 1) : i;
      auto& bytes_of = planes[plane];
      if (bytes_of.empty()) bytes_of.resize(static_cast<std::size_t>(cols * bytes * rowsOf(i)));
      frame.planes[plane] = {bytes_of.data(), std::ptrdiff_t{cols} * bytes};
      frame.components[i] = {.plane = plane,
                             .offset_bytes = static_cast<std::uint8_t>(how.pairs && i == 2 ? bytes : 0),
                             .step_bytes = static_cast<std::uint8_t>(channels * bytes),
                             .bits = static_cast<std::uint8_t>(how.bits)};
    }
    for (auto& plane : planes) {
      for (auto& byte : plane) byte = static_cast<std::uint8_t>(random());
    }
    if (bytes == 1) return;
    for (auto& plane : planes) {
      for (std::size_t i = 1; i < plane.size(); i += 2)
        plane[i] &= static_cast<std::uint8_t>((1 << (how.bits - 8)) - 1);
    }
  }
  [[nodiscard]] int colsOf(int i) const { return i == 0 ? frame.width : sub(frame.width, frame.chroma_shift_x); }
  [[nodiscard]] int rowsOf(int i) const { return i == 0 ? frame.height : sub(frame.height, frame.chroma_shift_y); }
  static int sub(int samples, int shift) { return (samples + (1 << shift) - 1) >> shift; }

  // The top 8 bits of a sample.
  [[nodiscard]] double sample(std::size_t i, int c, int r) const {
    const Component& what = frame.components[i];
    c = std::clamp(c, 0, colsOf(static_cast<int>(i)) - 1);
    r = std::clamp(r, 0, rowsOf(static_cast<int>(i)) - 1);
    const Plane& plane = frame.planes[what.plane];
    const std::uint8_t* at = plane.data + r * plane.stride_bytes + what.offset_bytes + c * what.step_bytes;
    return what.bits > 8 ? (at[0] | at[1] << 8) >> (what.bits - 8) : at[0];
  }
  // Where a luma sample's middle lies among a component's samples. Blocks of whole samples take these as they are.
  struct Place {
    int first;
    double next;  // share of the sample after it
  };
  static Place placeOf(int luma, int shift, int block) {
    if (block % (1 << shift) == 0) return {luma >> shift, 0};
    const double at = (luma + 0.5) / (1 << shift) - 0.5;
    return {static_cast<int>(std::floor(at)), at - std::floor(at)};
  }
  [[nodiscard]] double at(std::size_t i, const Place& across, const Place& down) const {
    const auto row = [&](int r) {
      return std::lerp(sample(i, across.first, r), sample(i, across.first + 1, r), across.next);
    };
    return std::lerp(row(down.first), row(down.first + 1), down.next);
  }
  // Over the block of luma samples of pixel (x, y).
  [[nodiscard]] double mean(std::size_t i, int x, int y, const Case& how) const {
    const int shift_x = i > 0 ? how.chroma_x : 0, shift_y = i > 0 ? how.chroma_y : 0;
    double sum = 0;
    for (int r = y * how.down; r < (y + 1) * how.down; ++r) {
      for (int c = x * how.across; c < (x + 1) * how.across; ++c) {
        sum += at(i, placeOf(c, shift_x, how.across), placeOf(r, shift_y, how.down));
      }
    }
    return sum / (how.across * how.down);
  }

  Frame frame;
  std::array<std::vector<std::uint8_t>, 3> planes;
};

class SeenColors : public testing::TestWithParam<Case> {};

TEST_P(SeenColors, AreTheMeansOfTheirSamples) {
  const Case& how = GetParam();
  const Noise noise(how);
  // BT.709 with limited range, in codes.
  const glm::mat3 to_rgb(glm::vec3(1.1644F), glm::vec3(0, -0.2132F, 2.1124F), glm::vec3(1.7927F, -0.5329F, 0));
  const glm::vec3 bias(-0.9729F, 0.3015F, -1.1334F);
  SeenColor seen;
  seen.make(noise.frame, {how.across, how.down}, to_rgb, bias);
  ASSERT_EQ(seen.width(), how.width / how.across);
  ASSERT_EQ(seen.height(), how.height / how.down);
  ASSERT_EQ(seen.rgba().size(), static_cast<std::size_t>(4 * seen.width() * seen.height()));
  double worst = 0, sum = 0;
  for (int y = 0; y < seen.height(); ++y) {
    for (int x = 0; x < seen.width(); ++x) {
      const std::uint8_t* pixel = &seen.rgba()[static_cast<std::size_t>(4 * (y * seen.width() + x))];
      EXPECT_EQ(pixel[3], 255);
      for (int k = 0; k < 3; ++k) {
        double value = 255 * static_cast<double>(bias[k]);
        for (std::size_t i = 0; i < 3; ++i) {
          value += static_cast<double>(to_rgb[static_cast<int>(i)][k]) * noise.mean(i, x, y, how);
        }
        const double error = pixel[k] - std::clamp(value, 0.0, 255.0);
        worst = std::max(worst, std::abs(error));
        sum += error;
      }
    }
  }
  EXPECT_LT(worst, 0.9) << "half a code is rounding";
  EXPECT_NEAR(sum / (3 * seen.width() * seen.height()), 0, 0.15);
}

INSTANTIATE_TEST_SUITE_P(, SeenColors,
                         testing::Values(Case{64, 34, 1, 1, 1, 1}, Case{65, 35, 1, 1, 1, 1}, Case{64, 36, 1, 1, 2, 1},
                                         Case{66, 36, 1, 1, 3, 1}, Case{66, 36, 1, 1, 1, 3}, Case{67, 37, 1, 1, 4, 2},
                                         Case{96, 48, 1, 1, 6, 3}, Case{96, 48, 0, 0, 12, 16}, Case{64, 34, 1, 0, 1, 2},
                                         Case{67, 34, 0, 0, 1, 1}, Case{66, 36, 1, 1, 1, 1, 10},
                                         Case{66, 36, 1, 1, 3, 2, 8, true}, Case{66, 36, 1, 1, 2, 3, 10, true},
                                         Case{64, 40, 0, 2, 1, 1}, Case{64, 40, 2, 2, 4, 2}, Case{1, 1, 1, 1, 1, 1},
                                         Case{3, 5, 1, 1, 1, 1}));

TEST(SeenColor, HasAtLeastAsManyPixelsAsAreShownAndLessThanTwiceAsMany) {
  for (int shown = 1; shown <= 1000; ++shown) {
    for (const int samples : {1, 2, 719, 720, 1296, 1920, 2160}) {
      const int factor = SeenColor::factorFor(samples, shown);
      EXPECT_TRUE(factor == 1 || samples / factor >= shown);
      EXPECT_TRUE(factor == 16 || samples / factor < 2 * shown);
    }
  }
}

TEST(SeenColor, GrayIsGray) {
  const std::array<std::uint8_t, 6> codes{0, 16, 100, 235, 255, 7};
  Frame frame;
  frame.width = 6;
  frame.height = 1;
  frame.components[0] = {.step_bytes = 1, .bits = 8};
  frame.planes[0] = {codes.data(), 6};
  SeenColor seen;
  seen.make(frame, {1, 1}, glm::mat3(glm::vec3(1), glm::vec3(0), glm::vec3(0)), glm::vec3(0));
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(seen.rgba()[4 * i + k], codes[i]);
  }
}

}  // namespace
}  // namespace relievo
