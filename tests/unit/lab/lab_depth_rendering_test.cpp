// SPDX-License-Identifier: Apache-2.0
// Rendered depth: each sample is the nearest code of the true height at its pixel's centre and time.
#include "app/lab/film/depth_rendering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "app/scene/height_field.h"

namespace relievo {
namespace {

HeightField fieldOf(const Frame& frame) {
  return HeightField::make(frame, {.bits = frame.components[0].bits}, TrueSurface::kVolume).value();
}

TEST(DepthRendering, IsTheNearestCodeAtEveryPixelCentre) {
  const auto s = makeTrueSurface("face-nodding");
  for (const int bits : {8, 10, 12, 16}) {
    const DepthFormat format{.cols = 90, .rows = 61, .frames_per_s = 25, .bits = bits};
    const Frame frame = renderDepth(*s, format, 7);
    const HeightField field = fieldOf(frame);
    const double highest = std::pow(2, bits) - 1;
    for (int r = 0; r < format.rows; ++r) {
      for (int c = 0; c < format.cols; ++c) {
        const double x = ((c + 0.5) / 90 - 0.5) * 160, y = (0.5 - (r + 0.5) / 61) * 108;
        ASSERT_EQ(field.code(c, r), std::lround(s->height(x, y, 0.28) / 40 * highest)) << bits << ": " << c << " " << r;
        ASSERT_NEAR(field.heightMm(c, r), s->height(x, y, 0.28), 0.5001 * 40 / highest);
      }
    }
  }
}

TEST(DepthRendering, FramesComeAtTheirTimesAndOwnTheirSamples) {
  const auto s = makeTrueSurface("rise", {.speed_mm_per_s = 10});
  std::vector<Frame> film = renderDepthFilm(*s, {.cols = 9, .rows = 7, .frames_per_s = 30, .bits = 16}, 12);
  ASSERT_EQ(film.size(), 12u);
  const Frame last = film.back();
  EXPECT_EQ(film[3].pts, MediaTime(std::chrono::milliseconds(100)));
  EXPECT_EQ(film[3].pts + film[3].duration, film[4].pts);
  film.clear();
  EXPECT_NEAR(fieldOf(last).heightMm(4, 3), s->height(0, 0, 11 / 30.0), 0.001);
  EXPECT_EQ(last.range, ColorRange::Full);
  EXPECT_EQ(last.width, 9);
  EXPECT_EQ(last.height, 7);
}

TEST(DepthRendering, StepHasNoCodeBetweenItsLevels) {
  const auto s = makeTrueSurface("step");
  const Frame frame = renderDepth(*s, {.cols = 720, .rows = 486, .bits = 8}, 0);
  const HeightField field = fieldOf(frame);
  for (int r = 0; r < 486; ++r) {
    int edges = 0;
    for (int c = 0; c < 720; ++c) {
      const auto code = field.code(c, r);
      ASSERT_TRUE(code == 175 || code == 80) << code;  // 27.5 and 12.5 mm of 40, times 255
      edges += c > 0 && code != field.code(c - 1, r) ? 1 : 0;
    }
    ASSERT_EQ(edges, 1) << r;
  }
}

struct Moments {
  double mean = 0, sigma = 0, kurtosis = 0;
};
Moments momentsOf(const std::vector<double>& values) {
  Moments m;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) m.mean += v / n;
  double second = 0, fourth = 0;
  for (const double v : values) {
    const double square = (v - m.mean) * (v - m.mean);
    second += square / n;
    fourth += square * square / n;
  }
  m.sigma = std::sqrt(second);
  m.kurtosis = fourth / (second * second);
  return m;
}

TEST(DepthRendering, NoiseIsGaussianWhiteAndNewInEveryFrame) {
  const auto s = makeTrueSurface("shallow-plane");
  const DepthFormat format{.cols = 200, .rows = 150, .bits = 16, .noise_share = 0.01};
  const Frame frame = renderDepth(*s, format, 0), next_frame = renderDepth(*s, format, 1);
  const HeightField first = fieldOf(frame), next = fieldOf(next_frame);
  std::vector<double> noise, product_in_time, product_in_space, product_in_rows;
  for (int r = 1; r < format.rows; ++r) {
    for (int c = 1; c < format.cols; ++c) {
      const auto error = [&](const HeightField& field, int column, int row) {
        return (field.heightMm(column, row) - s->height(field.grid().x(column), field.grid().y(row), 0)) / 40;
      };
      noise.push_back(error(first, c, r));
      product_in_time.push_back(error(first, c, r) * error(next, c, r));
      product_in_space.push_back(error(first, c, r) * error(first, c - 1, r));
      product_in_rows.push_back(error(first, c, r) * error(first, c, r - 1));
    }
  }
  const Moments m = momentsOf(noise);  // 30,000 samples: the bounds are five standard errors
  EXPECT_NEAR(m.mean, 0, 5 * 0.01 / std::sqrt(30000.0));
  EXPECT_NEAR(m.sigma, 0.01, 5 * 0.01 / std::sqrt(60000.0));
  EXPECT_NEAR(m.kurtosis, 3, 5 * std::sqrt(24 / 30000.0));
  for (const auto& products : {product_in_time, product_in_space, product_in_rows}) {
    EXPECT_NEAR(momentsOf(products).mean / 1e-4, 0, 5 / std::sqrt(30000.0));
  }
}

TEST(DepthRendering, NoiseOfASeedIsAlwaysTheSame) {
  const auto s = makeTrueSurface("plane");
  const auto codes = [&](std::uint64_t seed) {
    const Frame frame =
        renderDepth(*s, {.cols = 20, .rows = 15, .bits = 12, .noise_share = 0.02, .noise_seed = seed}, 3);
    const HeightField f = fieldOf(frame);
    std::vector<std::uint32_t> all;
    for (int r = 0; r < 15; ++r) {
      for (int c = 0; c < 20; ++c) all.push_back(f.code(c, r));
    }
    return all;
  };
  EXPECT_EQ(codes(5), codes(5));
  EXPECT_NE(codes(5), codes(6));
}

TEST(DepthRendering, NoiseIsCutAtTheEndsOfTheCodes) {
  const auto s = makeTrueSurface("sphere");
  const Frame frame = renderDepth(*s, {.cols = 90, .rows = 60, .bits = 8, .noise_share = 0.5}, 0);
  const HeightField f = fieldOf(frame);
  std::vector<int> counts(256);
  for (int r = 0; r < 60; ++r) {
    for (int c = 0; c < 90; ++c) ++counts[f.code(c, r)];
  }
  EXPECT_GT(counts[0], 1000);  // the floor lies at 15 % of full scale
  EXPECT_GT(counts[255], 100);
  EXPECT_LT(counts[1], 100);
}

}  // namespace
}  // namespace relievo
