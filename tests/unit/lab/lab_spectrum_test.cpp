// SPDX-License-Identifier: Apache-2.0
// Power spectral densities of signals whose spectrum is known on paper.
#include "app/lab/numbers/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace relievo {
namespace {

constexpr double kTickS = 0.001;
constexpr std::size_t kLength = 10000;

std::vector<double> sine(double amplitude, double hz, double offset) {
  std::vector<double> signal(kLength);
  for (std::size_t i = 0; i < kLength; ++i) {
    signal[i] = offset + amplitude * std::sin(2 * std::numbers::pi * hz * kTickS * static_cast<double>(i) + 0.3);
  }
  return signal;
}

// A sine of amplitude A has the power A^2/2; a Hann window spreads it over 1.5 steps of frequency.
TEST(Spectrum, OfASineHasItsPowerAtItsFrequency) {
  auto spectrum = Spectrum::make(kLength, kTickS).value();
  spectrum.add(sine(3, 15, 40));
  const auto density = spectrum.density();
  EXPECT_DOUBLE_EQ(spectrum.stepHz(), 0.1);
  ASSERT_EQ(density.size(), kLength / 2 + 1);
  EXPECT_NEAR(density[150], 4.5 / (1.5 * 0.1), 1e-9);
  EXPECT_NEAR(toDecibel(density[150]), 14.771, 1e-3);
  EXPECT_NEAR(density[151] / density[150], 0.25, 1e-9);  // the window's own shape: 6 dB down beside the peak
  EXPECT_NEAR(density[149] / density[150], 0.25, 1e-9);
  EXPECT_LT(toDecibel(density[155]), -200);
  EXPECT_LT(toDecibel(density[0]), -200) << "the mean is no part of it";
}

// Parseval: the density over all frequencies is the variance.
TEST(Spectrum, SumsUpToTheVariance) {
  auto spectrum = Spectrum::make(kLength, kTickS).value();
  spectrum.add(sine(3, 15, 40));
  const auto density = spectrum.density();
  EXPECT_NEAR(std::accumulate(density.begin(), density.end(), 0.0) * spectrum.stepHz(), 4.5, 1e-9);

  auto of_noise = Spectrum::make(kLength, kTickS).value();
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.2);
  for (int s = 0; s < 10; ++s) {
    std::vector<double> segment(kLength);
    for (double& value : segment) value = noise(random);
    of_noise.add(segment);
  }
  const auto flat = of_noise.density();
  EXPECT_NEAR(std::accumulate(flat.begin(), flat.end(), 0.0) * of_noise.stepHz(), 0.04, 0.04 * 0.02);
  const double low = std::accumulate(flat.begin() + 1, flat.begin() + 1001, 0.0) / 1000;
  EXPECT_NEAR(low, 0.04 / 500, 0.04 / 500 * 0.05) << "white: the same density everywhere up to 500 Hz";
}

TEST(Spectrum, IsTheMeanOfItsSegments) {
  auto spectrum = Spectrum::make(kLength, kTickS).value();
  spectrum.add(sine(2, 30, 0));
  spectrum.add(std::vector<double>(kLength, 1.0));
  EXPECT_NEAR(spectrum.density()[300], 2 / (1.5 * 0.1) / 2, 1e-9);
}

TEST(Spectrum, OfNothingIsFarDown) {
  auto spectrum = Spectrum::make(kLength, kTickS).value();
  spectrum.add(std::vector<double>(kLength, 0.0));
  EXPECT_EQ(toDecibel(spectrum.density()[150]), -300);
}

}  // namespace
}  // namespace relievo
