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

TEST(TouchPlan, WhatIsSmoothAlreadyNeedsNoBroadLevel) {
  EXPECT_EQ(planFor(16, 0, true).scale.broad_mm, 0);
  const TouchPlan noise = planFor(8, 0.4, true, 0);
  const FeltScale coarse = planFor(8, 0, true, 0).scale, noisy = noise.scale;
  EXPECT_EQ(coarse.broad_mm, 2 * coarse.wide_mm);
  EXPECT_EQ(noisy.broad_mm, 2.5 * noisy.wide_mm);
  const auto ball = [](const FeltScale& scale) { return std::pow(scale.broad_mm / kSigmaPerPitch, 2) / 150; };
  EXPECT_NEAR(coarse.broad_even_mm, ball(coarse) + 40.0 / 255 / 2, 1e-9);
  const double across = noisy.broad_mm / kSigmaPerPitch * 720 / 160;  // samples of a block, of which six rows are read
  EXPECT_NEAR(noisy.broad_even_mm, ball(noisy) + 3 * std::sqrt(6) * noise.measure.noise_mm / std::sqrt(6 * across),
              1e-3)
      << "three deviations of what a block of one frame leaves of the noise: frames are judged one by one";
  EXPECT_LT(noisy.broad_even_mm, 0.8) << "the bend of a ball of 45 mm";
}

// Six tenths as wide, the middle level has 1/.6 of the steps' error n: n (n/.6 - n).
TEST(TouchPlan, WhereALevelWouldFlattenMoreThanItSavesANarrowerOneCounts) {
  const TouchPlan plan = planFor(8, 0, true, 0);
  const FeltScale& s = plan.scale;
  const double of_steps = 0.5 * 40.0 / 255 / 5.06;  // the slope's error under a width of 1 mm
  EXPECT_NEAR(s.middle_mm, 0.6 * s.wide_mm, 1e-9);
  EXPECT_NEAR(s.wide_even_mm, 2 * 9 / kSigmaPerPitch * of_steps * std::sqrt(1 / 0.6 - 1), 1e-6);
  EXPECT_EQ(planFor(16, 0, true).scale.middle_mm, 0) << "as fine as it is, the wide level is narrow";
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
