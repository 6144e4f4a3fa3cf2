// SPDX-License-Identifier: Apache-2.0
// Plans of clips, and the widths and laws planned from them.
#include "app/depth_window/touch_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "app/depth_window/waves.h"
#include "app/haptics/method/felt_surface.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr double kPeriod = 1.0 / 30;

using test::makeGrayFrame;

TouchPlan planFor(int bits, double noise_mm, bool moving, double swell_mm = 2, double length_mm = 31.416) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, noise_mm > 0 ? noise_mm : 1e-9);
  std::vector<Frame> frames;
  std::vector<TimedSurface> surfaces;
  const double top = (1 << bits) - 1;
  const GridMapping grid(kVolume, 720, 486);
  for (int k = 0; k < 4; ++k) {
    frames.push_back(makeGrayFrame(720, 486, bits, mediaTime(k * kPeriod), [&](int c, int r) {
      const double swell = swell_mm * std::sin(2 * std::numbers::pi / length_mm * grid.y(r));
      const double z = 18 + 0.2 * grid.x(c) + swell + (moving ? 0.5 * k : 0) + noise(random);
      return std::clamp(z / 40, 0.0, 1.0) * top + 0.5;
    }));
    surfaces.push_back(
        {HeightField::make(frames.back(), {.bits = bits}, kVolume).value(), frames.back().pts, frames.back().owner});
  }
  return planTouch(measureClip(surfaces));
}

TEST(TouchPlan, TakesWhatTheClipNeedsAndNoMore) {
  const TouchPlan fine = planFor(16, 0, true), coarse = planFor(8, 0, true), noisy = planFor(8, 0.4, true),
                  still = planFor(8, 0, false);
  EXPECT_LT(fine.scale.wide_mm, 0.7);
  EXPECT_EQ(fine.scale.wide_time, TimeLaw::Fitted);
  EXPECT_NEAR(coarse.measure.quantum_mm, 40.0 / 255, 1e-9);
  EXPECT_EQ(coarse.measure.noise_mm, 0);
  EXPECT_NEAR(coarse.measure.speed_mm_per_s, 15, 5);
  EXPECT_GT(coarse.scale.wide_mm, 0.8);
  EXPECT_NEAR(noisy.measure.noise_mm, 0.4, 0.06);
  EXPECT_EQ(noisy.scale.wide_time, TimeLaw::Adapted);
  EXPECT_GT(noisy.scale.wide_steady_mm, 1.5 * coarse.scale.wide_steady_mm);
  EXPECT_GT(noisy.scale.clamp_mm, fine.scale.clamp_mm);
  EXPECT_TRUE(still.measure.still);
  EXPECT_NE(still.scale.wide_time, TimeLaw::Hold) << "a film that begins still may move later";
  // A black lead-in carries no information: the depth after it may be coarse.
  const Frame black = makeGrayFrame(90, 61, 8, {}, [](int, int) { return 0; });
  const TimedSurface alone{HeightField::make(black, {.bits = 8}, kVolume).value(), {}, black.owner};
  EXPECT_NEAR(planTouch(measureClip(std::span(&alone, 1))).scale.wide_mm, coarse.scale.wide_mm, 1e-9);
  EXPECT_EQ(measureClip({}).frames, 0);
}

// The error of a flat relief's slope due to noise is an error of the force's direction in radians: a share of the
// force.
TEST(TouchPlan, TellsWhatNoiseLeavesHoweverFineThePictureIs) {
  constexpr DisplayVolume kSmall{40, 30, 40};
  std::mt19937 random(7);
  struct Case {
    int cols;
    double noise_mm;
    bool still;
  };
  for (const auto& [cols, noise_mm, still] : {Case{180, 0.4, false},
                                              {180, 0.12, false},
                                              {960, 0.4, false},
                                              {960, 0.12, false},
                                              {960, 0.8, false},
                                              {480, 0.12, true}}) {
    std::normal_distribution<double> noise(0, noise_mm);
    SurfaceWindow window;
    for (TimedSurface& surface : window.frames) {
      if (still) random.seed(7);
      noise.reset();
      const Frame frame = makeGrayFrame(cols, cols * 3 / 4, 16, mediaTime(window.count++ * kPeriod), [&](int, int) {
        return std::clamp((20 + noise(random)) / 40, 0.0, 1.0) * 65535 + 0.5;
      });
      surface = {HeightField::make(frame, {.bits = 16}, kSmall).value(), frame.pts, frame.owner};
    }
    const TouchPlan plan = planTouch(measureClip(window.frames));
    FeltScale scale = plan.scale;
    scale.broad_mm = 0;  // the plan's error is that of a curved place
    FeltSurface felt(scale);
    double sum = 0;
    int places = 0;
    for (int tick = 0; tick < 20; ++tick) {  // frames that come together are read in 18 ticks
      ASSERT_TRUE(felt.moveTo(window, mediaTime(2 * kPeriod)));
      static_cast<void>(felt.at(0, 0));
      felt.prepare(window, mediaTime(2 * kPeriod), 0, 0);
    }
    for (int k = 0; k < 10; ++k) {
      ASSERT_TRUE(felt.moveTo(window, mediaTime((2 + 0.1 * k) * kPeriod)));
      for (double y = -9; y <= 9; y += 1.2) {
        for (double x = -14; x <= 14; x += 1.2, ++places) {
          const SurfacePoint at = felt.at(x, y);
          sum += at.zx * at.zx + at.zy * at.zy;
        }
      }
    }
    const double left = std::sqrt(sum / places);
    EXPECT_NEAR(left, plan.error, 0.35 * plan.error) << cols << ' ' << noise_mm << ' ' << still;
  }
}

// A wave of three to four of the smoothing's blocks, as it is felt. Its amplitude counts at six places of ten: .81 of a
// sine's height, which is 1.14 of its root mean square.
TEST(TouchPlan, TellsWhatSmoothingLosesOfWaves) {
  constexpr double kWidthMm = 2, kBlockMm = kWidthMm / kSigmaPerPitch, kHighMm = 0.3;
  for (const double blocks : {3.1, 3.7}) {
    const double turns_per_mm = 2 * std::numbers::pi / (blocks * kBlockMm);
    const GridMapping grid(kVolume, 720, 486);
    const Frame frame = makeGrayFrame(720, 486, 16, {}, [&](int c, int) {
      return (20 + kHighMm * std::sin(turns_per_mm * grid.x(c))) / 40 * 65535 + 0.5;
    });
    SurfaceWindow window{.count = 1};
    window.frames[0] = {HeightField::make(frame, {.bits = 16}, kVolume).value(), {}, frame.owner};
    FeltSurface felt({.wide_mm = kWidthMm, .clamp_mm = 10});
    ASSERT_TRUE(felt.moveTo(window, {}));
    double lost2 = 0;
    int places = 0;
    for (double x = -30; x < 30; x += 0.37, ++places) {
      const double off = turns_per_mm * kHighMm * std::cos(turns_per_mm * x) - felt.at(x, 0.3).zx;
      lost2 += off * off;
    }
    const double told = flattenedBy(kWidthMm, wavesOf(std::span(window.frames).first(1), 0, 0, true));
    const double lost = std::sqrt(lost2 / places);
    EXPECT_GT(told, lost) << blocks;
    EXPECT_LT(told, 1.6 * lost) << blocks;
  }
}

// White noise s of samples p apart leaves s p/(w sqrt(4 pi)) of itself under a Gaussian of width w, and sqrt(.48) of
// that under a B-spline in time.
TEST(TouchPlan, TheClampHoldsFiveDeviationsOfTheNarrowLevelsNoise) {
  const ClipMeasure noisy{.frames = 4, .quantum_mm = 0.001, .noise_mm = 0.4, .sample_mm = 0.22, .period_s = kPeriod};
  const double left = 0.4 * 0.22 / (0.28 * std::sqrt(4 * std::numbers::pi)) * std::sqrt(0.48);
  EXPECT_NEAR(planTouch(noisy).scale.clamp_mm, 5 * left, 1e-3);
}

// A spline in time flattens a nod by the square of the frame period.
TEST(TouchPlan, SmoothsStepsInTimeWhereFramesAreQuick) {
  ClipMeasure steps{.frames = 4, .quantum_mm = 40.0 / 255, .sample_mm = 0.22, .period_s = kPeriod};
  EXPECT_EQ(planTouch(steps).scale.wide_time, TimeLaw::Adapted);
  steps.period_s = 1.0 / 15;
  EXPECT_EQ(planTouch(steps).scale.wide_time, TimeLaw::Fitted);
  steps.noise_mm = 0.4;
  EXPECT_EQ(planTouch(steps).scale.wide_time, TimeLaw::Adapted) << "noise is worse";
}

// What a codec makes of the steps moves more from frame to frame than rounding does.
TEST(TouchPlan, StepsOfACodecCountAsSteadyUpToMore) {
  ClipMeasure steps{.frames = 4, .quantum_mm = 40.0 / 255, .sample_mm = 0.22, .period_s = kPeriod};
  const double rounded = planTouch(steps).scale.wide_steady_mm;
  EXPECT_NEAR(rounded, 0.12 * 40 / 255, 1e-9);
  steps.ripples = 0.01;
  EXPECT_NEAR(planTouch(steps).scale.wide_steady_mm, 3 * rounded, 1e-9);
}
// Where a share e of the worst slope's q/(5.06 w) and the flattening's .0005 w^4 grow as fast, w^5 = e q/(2 x 5.06 x
// .0005); the search goes in steps of 2 %. e is 1/2 for rounded depth, and four times that where a codec was at work.
TEST(TouchPlan, TheWidthSuitsTheStepsAndWhatACodecMadeOfThem) {
  ClipMeasure steps{.frames = 4, .quantum_mm = 40.0 / 255, .sample_mm = 0.22, .period_s = kPeriod};
  EXPECT_NEAR(planTouch(steps).scale.wide_mm, std::pow(0.5 * 40.0 / 255 / 0.00506, 0.2), 0.02 * 2);
  steps.ripples = 0.0005;
  EXPECT_NEAR(planTouch(steps).scale.wide_mm, std::pow(0.5 * 40.0 / 255 / 0.00506, 0.2), 0.02 * 2);
  steps.ripples = 0.003;
  EXPECT_NEAR(planTouch(steps).scale.wide_mm, std::pow(2 * 40.0 / 255 / 0.00506, 0.2), 0.02 * 2);
}

// Waves of 6 mm and a tightest radius of 3 mm have .396 mm in the smallest blocks without any codec.
TEST(TouchPlan, WhatACodecLeavesBesideWavesWidensTheSmoothing) {
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

TEST(TouchPlan, WhatIsSmoothAlreadyNeedsNoBroadLevel) {
  EXPECT_EQ(planFor(16, 0, true).scale.broad_mm, 0);
  const TouchPlan noise = planFor(8, 0.4, true, 0);
  const FeltScale coarse = planFor(8, 0, true, 0).scale, noisy = noise.scale;
  const auto ball = [](const FeltScale& s) { return std::pow(s.broad_mm / kSigmaPerPitch, 2) / 150; };
  EXPECT_EQ(coarse.broad_mm, 2 * coarse.wide_mm);
  EXPECT_NEAR(coarse.straight_mm, ball(coarse) + 40.0 / 255 / 2, 1e-9);
  const double across = noisy.broad_mm / kSigmaPerPitch * 720 / 160;  // samples of a block, of which six rows are read
  EXPECT_EQ(noisy.broad_mm, 2.5 * noisy.wide_mm);
  EXPECT_NEAR(noisy.straight_mm, ball(noisy) + 3 * std::sqrt(6) * noise.measure.noise_mm / std::sqrt(6 * across), 1e-3)
      << "three deviations of what a block of one frame leaves of the noise: frames are judged one by one";
  EXPECT_LT(noisy.straight_mm, 0.8) << "the bend of a ball of 45 mm";
}

// Waves of half a step on a slope bend by less than a step, and are lost on the broad level; under noise too.
TEST(TouchPlan, SwellsThatABroadLevelWouldFlattenForbidIt) {
  EXPECT_GT(planFor(8, 0, false, 0.005, 10).scale.broad_mm, 0) << "too low to be felt";
  EXPECT_EQ(planFor(8, 0, false, 0.06, 10).scale.broad_mm, 0);
  EXPECT_EQ(planFor(8, 0, false, 0.05, 13).scale.broad_mm, 0) << "2.4 of its blocks, which lose twice what four do";
  EXPECT_EQ(planFor(8, 0.4, true, 0.06, 10).scale.broad_mm, 0);
  EXPECT_EQ(planFor(8, 2, true, 0.6, 14).scale.broad_mm, 0);
}

// The terraces of a shallow slope, 15.7 and 5.2 mm wide, are no swells: a broad level is there to remove them.
TEST(TouchPlan, TerracesForbidNoBroadLevel) {
  for (const double slope : {0.01, 0.03}) {
    const Frame frame = makeGrayFrame(720, 486, 8, {}, [&](int c, int r) {
      const GridMapping grid(kVolume, 720, 486);
      return (20 + slope * (0.8 * grid.x(c) + 0.6 * grid.y(r))) / 40 * 255 + 0.5;
    });
    const TimedSurface alone{HeightField::make(frame, {.bits = 8}, kVolume).value(), {}, frame.owner};
    EXPECT_GT(planTouch(measureClip(std::span(&alone, 1))).scale.broad_mm, 0) << slope;
  }
}

TEST(TouchPlan, NoiseDithersTheStepsAway) {
  ClipMeasure m{.frames = 4, .quantum_mm = 40.0 / 255, .noise_mm = 0.4, .sample_mm = 0.22, .period_s = kPeriod};
  const double noisy = planTouch(m).scale.wide_mm;
  m.quantum_mm = 1e-6;
  EXPECT_EQ(planTouch(m).scale.wide_mm, noisy);
}

TEST(TouchPlan, OfAFilmItsFirstFourFramesTell) {
  std::vector<TimedSurface> surfaces;
  for (int k = 0; k < 8; ++k) {
    const Frame frame =
        makeGrayFrame(90, 61, 8, mediaTime(k * kPeriod), [&](int c, int) { return c + (k < 4 ? 0 : k); });
    surfaces.push_back({HeightField::make(frame, {.bits = 8}, kVolume).value(), frame.pts, frame.owner});
  }
  EXPECT_TRUE(planFilm(surfaces).measure.still);
  EXPECT_FALSE(planTouch(measureClip(surfaces)).measure.still);
}

// Noise of less than one step of the codes is no reason for the smoother time law. However coarse the codes are, the
// wide level differs from the narrow one by 0.3 mm at most.
TEST(TouchPlan, NoiseIsWhatIsMoreThanAStep) {
  const ClipMeasure coarse{.frames = 4, .quantum_mm = 0.6, .noise_mm = 0.03, .sample_mm = 0.5, .period_s = kPeriod};
  EXPECT_EQ(planTouch(coarse).scale.narrow_time, TimeLaw::Linear);
  EXPECT_NEAR(planTouch(coarse).scale.clamp_mm, 0.3, 1e-9);
}

// Under the inverse law a code step is a hundred times as high at the far plane as at the near one. What counts is the
// rms over the picture, and noise of so many codes is as many of these steps.
TEST(TouchPlan, StepsUnderTheInverseLawAreThoseOfTheWholePicture) {
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
TEST(TouchPlan, SamplesThatAreNotSquareCountByTheirArea) {
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

TEST(TouchPlan, TellsNoErrorThatItCannotName) {
  const auto told = [](const TouchPlan& plan, const char* part) { return plan.reason.find(part) != std::string::npos; };
  const Frame flat = makeGrayFrame(90, 61, 16, {}, [](int, int) { return 30000; });
  const TimedSurface alone{HeightField::make(flat, {.bits = 16}, kVolume).value(), {}, flat.owner};
  const TouchPlan plan = planTouch(measureClip(std::span(&alone, 1)));
  EXPECT_LT(plan.error, 0.001);
  EXPECT_TRUE(told(plan, "expected force error under 0.1 %")) << plan.reason;
  const TouchPlan coarse = planFor(8, 0, true);
  EXPECT_FALSE(told(coarse, " 0.0 %")) << coarse.reason;
  EXPECT_TRUE(told(coarse, "expected force error about ")) << coarse.reason;
  EXPECT_TRUE(told(coarse, describe(coarse.scale).c_str())) << coarse.reason;
}

}  // namespace
}  // namespace relievo
