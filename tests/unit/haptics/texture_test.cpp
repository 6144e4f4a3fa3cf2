// SPDX-License-Identifier: Apache-2.0
// Texture: the spectrum of the force against closed forms, its end at half the rate, and its energy.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "tests/support/film/method_stage.h"

namespace relievo {
namespace {

constexpr double kTick = 0.001, kStiffness = 0.5, kDeep = 3;

SurfaceWindow plane() {
  constexpr DisplayVolume kVolume{160, 108, 40};
  const Frame frame = test::makeReliefFrame(240, 162, kVolume, {}, [](double, double) { return 20.0; });
  return test::makeWindow(std::span(&frame, 1), kVolume);
}

RelievoMethod rippled(double amplitude, double wavelength) {
  return RelievoMethod({.stiffness_n_per_mm = kStiffness, .texture = {amplitude, wavelength}});
}

// The force along z of a finger that goes 100 mm at most.
std::vector<double> strokeForce(RelievoMethod& method, double mm_per_s, double y_per_x = 0) {
  const SurfaceWindow w = plane();
  std::vector<double> force;
  static_cast<void>(method.update({-51, 0, 21}, w, {}));
  const int ticks = static_cast<int>(std::min(100 / (mm_per_s * kTick), 2000.0));
  for (int i = 0; i < ticks; ++i) {
    const double x = -50 + mm_per_s * kTick * i;
    force.push_back(method.update({x, y_per_x * x, 20 - kDeep}, w, {}).force_n.z);
  }
  return force;
}

// Amplitude of the part at `hz`: a discrete Fourier transform at one frequency, under a Hann window.
double amplitudeAt(const std::vector<double>& values, std::size_t from, double hz) {
  std::complex<double> sum = 0;
  double weights = 0, mean = 0;
  const auto n = static_cast<double>(values.size() - from);
  for (std::size_t i = from; i < values.size(); ++i) mean += values[i] / n;
  for (std::size_t i = from; i < values.size(); ++i) {
    const auto k = static_cast<double>(i - from);
    const double weight = 0.5 - 0.5 * std::cos(2 * M_PI * k / n);
    weights += weight;
    sum += weight * (values[i] - mean) * std::polar(1.0, -2 * M_PI * hz * kTick * k);
  }
  return 2 * std::abs(sum) / weights;
}

TEST(Ripple, TheForceSwingsByStiffnessTimesAmplitudeAtSpeedOverWavelength) {
  for (const double speed : {50.0, 100.0, 300.0, 1000.0}) {
    for (const double wavelength : {0.8, 2.0, 5.0}) {
      const double hz = speed / wavelength;
      if (hz > Ripple::kFlat / kTick) continue;
      auto method = rippled(0.05, wavelength);
      const auto force = strokeForce(method, speed);
      const std::size_t from = 20;
      SCOPED_TRACE(testing::Message() << speed << " mm/s, " << wavelength << " mm");
      EXPECT_NEAR(amplitudeAt(force, from, hz), kStiffness * 0.05, 0.05 * kStiffness * 0.05);
      // It is the peak of the spectrum, in steps of the window's resolution.
      const double step = 1 / (static_cast<double>(force.size() - from) * kTick);
      for (double f = 5 * step; f < 500; f += step) {
        if (std::abs(f - hz) < 4 * step) continue;
        ASSERT_LT(amplitudeAt(force, from, f), 0.05 * kStiffness * 0.05) << f << " Hz";
      }
    }
  }
}

// 1 m/s over 1.2 mm are 833 Hz, which 1 kHz would fold down to 167.
TEST(Ripple, NothingIsLeftAboveHalfTheRate) {
  for (const double wavelength : {1.9, 1.2, 0.8, 0.3}) {
    auto method = rippled(0.05, wavelength);
    const auto force = strokeForce(method, 1000);
    double most = 0;
    for (std::size_t i = 20; i < force.size(); ++i) most = std::max(most, std::abs(force[i] - kStiffness * kDeep));
    EXPECT_LT(most, 0.01 * kStiffness * 0.05) << wavelength;
  }
}

TEST(Ripple, RunsAlongYAsAlongX) {
  auto method = rippled(0.05, 2);
  const auto force = strokeForce(method, 100, 0.5);
  EXPECT_NEAR(amplitudeAt(force, 20, 50), kStiffness * 0.05, 0.05 * kStiffness * 0.05);
  EXPECT_NEAR(amplitudeAt(force, 20, 25), kStiffness * 0.05, 0.05 * kStiffness * 0.05);
}

TEST(Ripple, AFingerThatRestsFeelsAStillForce) {
  auto method = rippled(0.1, 0.8);
  const SurfaceWindow w = plane();
  static_cast<void>(method.update({0.2, 0, 21}, w, {}));
  static_cast<void>(method.update({0.2, 0, 17}, w, {}));
  const glm::dvec3 first = method.update({0.2, 0, 17}, w, {}).force_n;
  for (int i = 0; i < 100; ++i) ASSERT_EQ(method.update({0.2, 0, 17}, w, {}).force_n, first);
  EXPECT_NEAR(first.z, kStiffness * (kDeep + 0.1), 0.01) << "on a crest: x is a quarter of the wavelength";
}

TEST(Ripple, NeverPulls) {
  auto method = rippled(0.2, 2);
  const SurfaceWindow w = plane();
  for (int i = 0; i < 4000; ++i) {
    const double z = 20.1 - 0.4 * std::abs(std::sin(0.003 * i));
    EXPECT_GE(method.update({0.01 * i - 20, 0, z}, w, {}).force_n.z, 0) << i;
  }
}

double givenBy(RelievoMethod& method, const SurfaceWindow& w, const std::vector<glm::dvec3>& path) {
  double given = 0;
  glm::dvec3 force(0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Touch touch = method.update(path[i], w, {});
    method.upkeep(w, {});
    if (i > 0) given += 0.5 * glm::dot(force + touch.force_n, path[i] - path[i - 1]);
    force = touch.force_n;
  }
  EXPECT_EQ(force, glm::dvec3(0)) << "it has come out";
  return given;
}

// A finger that enters at a valley and leaves at a crest would gain .5 N/mm x 3 mm x .2 mm = .3 mJ each time if the
// ripple kept no account of its energy.
TEST(Ripple, GivesNothingToAFingerThatGoesInAtAValleyAndOutAtACrest) {
  const SurfaceWindow w = plane();
  for (const int ticks : {20, 100, 400}) {  // up to 0.3 m/s
    auto method = rippled(0.1, 2);
    std::vector<glm::dvec3> path;
    const auto ease = [&](int i) { return 0.5 - 0.5 * std::cos(M_PI * i / ticks); };
    for (int i = 0; i <= ticks; ++i) path.emplace_back(1.5, 0, 21 - 4 * ease(i));
    for (int i = 0; i <= ticks; ++i) path.emplace_back(1.5 - ease(i), 0, 17);
    for (int i = 0; i <= ticks; ++i) path.emplace_back(0.5, 0, 17 + 4 * ease(i));
    EXPECT_LT(givenBy(method, w, path), 0.01) << ticks;
  }
}

TEST(Ripple, AStrokeIsGivenNoEnergy) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const SurfaceWindow w = plane();
  for (int n = 0; n < 200; ++n) {
    auto method = rippled(0.1, 0.8 + 3 * unit(random));
    const double seconds = 0.1 + unit(random), length = 60 * unit(random), wave = 3 * unit(random);
    std::vector<glm::dvec3> path;
    for (int i = 0; i * kTick <= seconds + kTick; ++i) {
      const double share = std::min(i * kTick / seconds, 1.0);
      path.emplace_back(length * std::sin(wave * share), 10 * unit(random) * 0.001 + 5 * share,
                        21 - 5 * std::pow(std::sin(M_PI * share), 0.5));
    }
    EXPECT_LT(givenBy(method, w, path), 0.01) << n;
  }
}

}  // namespace
}  // namespace relievo
