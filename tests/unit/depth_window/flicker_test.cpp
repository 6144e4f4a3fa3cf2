// SPDX-License-Identifier: Apache-2.0
// How much whole frames flicker, as distinct from motion.
#include "app/depth_window/flicker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "app/depth_window/touch_plan.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr double kPeriod = 1.0 / 30;

// A dome; `change` turns its height at (x, y) of a frame into that frame's.
using Made = std::function<double(double height, double x, int frame)>;
std::vector<TimedSurface> filmOf(int count, const Made& change) {
  const GridMapping grid(kVolume, 180, 122);
  std::vector<TimedSurface> film;
  for (int k = 0; k < count; ++k) {
    const Frame frame = test::makeGrayFrame(180, 122, 16, mediaTime(k * kPeriod), [&](int c, int r) {
      const double x = grid.x(c), y = grid.y(r);
      return std::clamp(change(30 - 0.002 * (x * x + y * y), x, k) / kVolume.depth_mm, 0.0, 1.0) * 65535 + 0.5;
    });
    film.push_back({HeightField::make(frame, {.bits = 16}, kVolume).value(), frame.pts, frame.owner});
  }
  return film;
}

constexpr double kShifts[] = {0.3, -0.2, 0.4, -0.5};

// By hand: the shifts .3 -.2 .4 -.5 change by -.5 .6 -.9, and these changes by 1.1 and -1.5.
TEST(Flicker, IsTheStandardDeviationOfShiftsThatAlternate) {
  const auto film = filmOf(4, [](double h, double, int k) { return h + kShifts[k]; });
  EXPECT_NEAR(flickerMm(film), std::sqrt((1.1 * 1.1 + 1.5 * 1.5) / 2 / 6), 0.01);
}

// Scaling by 1 + s shifts a height h by s h. The root mean square of the heights takes the place of one shift for all.
TEST(Flicker, CountsScalesByTheHeights) {
  const auto film = filmOf(4, [](double h, double, int k) { return h * (1 + 0.02 * kShifts[k]); });
  double square = 0;
  const GridMapping grid(kVolume, 180, 122);
  for (int c = 0; c < 180; ++c) {
    for (int r = 0; r < 122; ++r) square += std::pow(30 - 0.002 * (grid.x(c) * grid.x(c) + grid.y(r) * grid.y(r)), 2);
  }
  const double height = std::sqrt(square / (180 * 122));
  EXPECT_NEAR(flickerMm(film), 0.02 * height * std::sqrt((1.1 * 1.1 + 1.5 * 1.5) / 12), 0.01);
}

// A third of the picture moves away faster and faster, and the whole picture flickers.
TEST(Flicker, IsThatOfThePlacesThatDoNotMoveByThemselves) {
  const auto film = filmOf(4, [](double h, double x, int k) { return h + kShifts[k] + (x > 27 ? -0.8 * k * k : 0); });
  EXPECT_NEAR(flickerMm(film), std::sqrt((1.1 * 1.1 + 1.5 * 1.5) / 12), 0.03);
}

TEST(Flicker, IsNoMotionOfTheWholeScene) {
  const auto still = filmOf(4, [](double h, double, int) { return h; });
  const auto rising = filmOf(4, [](double h, double, int k) { return h + 0.8 * k; });
  const auto falling = filmOf(4, [](double h, double, int k) { return h - 0.4 * k * k; });
  const auto nearing = filmOf(4, [](double h, double, int k) { return h * (1 - 0.01 * k * k); });
  EXPECT_EQ(flickerMm(still), 0);
  EXPECT_LT(flickerMm(rising), 1e-3);
  EXPECT_EQ(flickerMm(falling), 0);
  EXPECT_EQ(flickerMm(nearing), 0);
}

TEST(Flicker, NeedsThreeFramesOfAShot) {
  auto film = filmOf(4, [](double h, double, int k) { return h + kShifts[k]; });
  EXPECT_EQ(flickerMm({}), 0);
  EXPECT_EQ(flickerMm(std::span(film).first(2)), 0);
  EXPECT_GT(flickerMm(std::span(film).first(3)), 0.4);
  film[2].shot = film[3].shot = 1;
  EXPECT_EQ(flickerMm(film), 0) << "two frames on either side of a cut";
}

// With little flicker the mean would flatten motion by more than it takes away: 200 mm/s^2 are .23 mm at 30 frames/s.
TEST(Flicker, ThePlanAveragesWhatIsWorthIt) {
  ClipMeasure m{.frames = 4, .quantum_mm = 40.0 / 255, .flicker_mm = 0.5, .sample_mm = 0.22, .period_s = kPeriod};
  EXPECT_EQ(planTouch(m).scale.narrow_time, TimeLaw::Mean);
  EXPECT_EQ(planTouch(m).scale.wide_time, TimeLaw::Mean);
  EXPECT_NE(planTouch(m).reason.find("flicker of 0.50 mm"), std::string::npos) << planTouch(m).reason;
  m.flicker_mm = 0.3;
  EXPECT_NE(planTouch(m).scale.wide_time, TimeLaw::Mean);
  m.flicker_mm = 0.5, m.period_s = 1.0 / 15;
  EXPECT_NE(planTouch(m).scale.wide_time, TimeLaw::Mean) << "slow frames";
}

}  // namespace
}  // namespace relievo
