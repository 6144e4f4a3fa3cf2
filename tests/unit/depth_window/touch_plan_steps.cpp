// SPDX-License-Identifier: Apache-2.0
// What the plan makes of the steps of the codes, of a codec's traces and of noise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>

#include "app/depth_window/touch_plan.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

using test::makeGrayFrame;

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr double kPeriod = 1.0 / 30;

// White noise s of samples p apart leaves s p/(w sqrt(4 pi)) of itself under a Gaussian of width w, and sqrt(.48) of
// that under a B-spline in time.
TEST(TouchPlanOfSteps, TheClampHoldsFiveDeviationsOfTheNarrowLevelsNoise) {
  const ClipMeasure noisy{.frames = 4, .quantum_mm = 0.001, .noise_mm = 0.4, .sample_mm = 0.22, .period_s = kPeriod};
  const double left = 0.4 * 0.22 / (0.28 * std::sqrt(4 * std::numbers::pi)) * std::sqrt(0.48);
  EXPECT_NEAR(planTouch(noisy).scale.clamp_mm, 5 * left, 1e-3);
}

// A spline in time flattens a nod by the square of the frame period.
TEST(TouchPlanOfSteps, SmoothsStepsInTimeWhereFramesAreQuick) {
  ClipMeasure steps{.frames = 4, .quantum_mm = 40.0 / 255, .sample_mm = 0.22, .period_s = kPeriod};
  EXPECT_EQ(planTouch(steps).scale.wide_time, TimeLaw::Adapted);
  steps.period_s = 1.0 / 15;
  EXPECT_EQ(planTouch(steps).scale.wide_time, TimeLaw::Fitted);
  steps.noise_mm = 0.4;
  EXPECT_EQ(planTouch(steps).scale.wide_time, TimeLaw::Adapted) << "noise is worse";
}

// What a codec makes of the steps moves more from frame to frame than rounding does.
TEST(TouchPlanOfSteps, StepsOfACodecCountAsSteadyUpToMore) {
  ClipMeasure steps{.frames = 4, .quantum_mm = 40.0 / 255, .sample_mm = 0.22, .period_s = kPeriod};
  const double rounded = planTouch(steps).scale.wide_steady_mm;
  EXPECT_NEAR(rounded, 0.12 * 40 / 255, 1e-9);
  steps.ripples = 0.01;
  EXPECT_NEAR(planTouch(steps).scale.wide_steady_mm, 3 * rounded, 1e-9);
}

// Where a share e of the worst slope's q/(5.06 w) and the flattening's .0005 w^4 grow as fast, w^5 = e q/(2 x 5.06 x
// .0005); the search goes in steps of 2 %. e is 1/2 for rounded depth, and four times that where a codec was at work.
TEST(TouchPlanOfSteps, TheWidthSuitsTheStepsAndWhatACodecMadeOfThem) {
  ClipMeasure steps{.frames = 4, .quantum_mm = 40.0 / 255, .sample_mm = 0.22, .period_s = kPeriod};
  EXPECT_NEAR(planTouch(steps).scale.wide_mm, std::pow(0.5 * 40.0 / 255 / 0.00506, 0.2), 0.02 * 2);
  steps.ripples = 0.0005;
  EXPECT_NEAR(planTouch(steps).scale.wide_mm, std::pow(0.5 * 40.0 / 255 / 0.00506, 0.2), 0.02 * 2);
  steps.ripples = 0.003;
  EXPECT_NEAR(planTouch(steps).scale.wide_mm, std::pow(2 * 40.0 / 255 / 0.00506, 0.2), 0.02 * 2);
}

// Waves of 6 mm and a tightest radius of 3 mm have .396 mm in the smallest blocks without any codec.
TEST(TouchPlanOfSteps, WhatACodecLeavesBesideWavesWidensTheSmoothing) {
  const auto width = [](const Waves& waves) {
    return planTouch({.frames = 4, .quantum_mm = 40.0 / 255, .waves_mm = waves, .sample_mm = 0.22, .period_s = kPeriod})
        .scale.wide_mm;
  };
  const double clean = width({0, 0.17, 0.55});
  EXPECT_EQ(width({0.06, 0.17, 0.55}), clean) << "what the waves have there";
  EXPECT_GT(width({0.15, 0.17, 0.55}), 1.25 * clean);
  EXPECT_LT(width({0.15, 0.17, 0.55}), 1.5 * clean);
  EXPECT_EQ(width({0.396, 1.16, 2.1}), width({0, 1.16, 2.1}));
  EXPECT_EQ(width({0.4, 0.7, 0}), width({0, 0.7, 0})) << "waves too fine for the largest blocks";
}

TEST(TouchPlanOfSteps, NoiseDithersTheStepsAway) {
  ClipMeasure m{.frames = 4, .quantum_mm = 40.0 / 255, .noise_mm = 0.4, .sample_mm = 0.22, .period_s = kPeriod};
  const double noisy = planTouch(m).scale.wide_mm;
  m.quantum_mm = 1e-6;
  EXPECT_EQ(planTouch(m).scale.wide_mm, noisy);
}

// Noise of less than one step of the codes is no reason for the smoother time law. However coarse the codes are, the
// wide level differs from the narrow one by 0.3 mm at most.
TEST(TouchPlanOfSteps, NoiseIsWhatIsMoreThanAStep) {
  const ClipMeasure coarse{.frames = 4, .quantum_mm = 0.6, .noise_mm = 0.03, .sample_mm = 0.5, .period_s = kPeriod};
  EXPECT_EQ(planTouch(coarse).scale.narrow_time, TimeLaw::Linear);
  EXPECT_NEAR(planTouch(coarse).scale.clamp_mm, 0.3, 1e-9);
}

// Under the inverse law a code step is a hundred times as high at the far plane as at the near one. What counts is the
// rms over the picture, and noise of so many codes is as many of these steps.
TEST(TouchPlanOfSteps, StepsUnderTheInverseLawAreThoseOfTheWholePicture) {
  const DepthCalibration calibration{.law = DepthLaw::Inverse, .bits = 8, .near_mm = 500, .far_mm = 5000};
  constexpr double kPerMm = 4500.0 / 40;  // of the scene, in mm of the volume
  const GridMapping grid(kVolume, 720, 486);
  const auto away = [&](int c, int r) { return 5000 - kPerMm * (20 + 0.15 * grid.x(c) + 0.1 * grid.y(r)); };
  double step2 = 0;
  for (int r = 0; r < 486; ++r) {
    for (int c = 0; c < 720; ++c) {
      const double step = away(c, r) * away(c, r) * (1.0 / 500 - 1.0 / 5000) / 255 / kPerMm;
      step2 += step * step / (720 * 486);
    }
  }
  const auto measured = [&](double noise_codes) {
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, noise_codes);
    const Frame frame = makeGrayFrame(720, 486, 8, {}, [&](int c, int r) {
      const double s = (1 / away(c, r) - 1.0 / 5000) / (1.0 / 500 - 1.0 / 5000);
      return std::clamp(255 * s + (noise_codes > 0 ? noise(random) : 0), 0.0, 255.0) + 0.5;
    });
    const TimedSurface alone{HeightField::make(frame, calibration, kVolume).value(), {}, frame.owner};
    return measureClip(std::span(&alone, 1));
  };
  const ClipMeasure clean = measured(0), noisy = measured(3);
  EXPECT_NEAR(clean.quantum_mm, std::sqrt(step2), 0.02 * std::sqrt(step2));
  EXPECT_EQ(clean.noise_mm, 0);
  EXPECT_NEAR(noisy.quantum_mm, std::sqrt(step2), 0.02 * std::sqrt(step2));
  EXPECT_NEAR(noisy.noise_mm, 3 * std::sqrt(step2), 0.3 * std::sqrt(step2));
  EXPECT_GT(planTouch(clean).scale.wide_mm, 1.7) << "no narrower than that of even steps as high";
}

// Samples that are three times as far apart down as across are as many to a square millimetre as square ones of the
// same area; noise of the same size needs the same smoothing.
TEST(TouchPlanOfSteps, SamplesThatAreNotSquareCountByTheirArea) {
  const auto planned = [](int cols, int rows) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 3);
    const Frame frame = makeGrayFrame(cols, rows, 8, {}, [&](int c, int) { return 100 + 0.1 * c + noise(random); });
    const TimedSurface alone{HeightField::make(frame, {.bits = 8}, {120, 120, 40}).value(), {}, frame.owner};
    return planTouch(measureClip(std::span(&alone, 1))).scale;
  };
  const FeltScale square = planned(400, 400), tall = planned(693, 231);
  EXPECT_NEAR(tall.clamp_mm, square.clamp_mm, 0.06 * square.clamp_mm);
  EXPECT_NEAR(tall.wide_mm, square.wide_mm, 0.06 * square.wide_mm);
}

}  // namespace
}  // namespace relievo
