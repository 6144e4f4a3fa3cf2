// SPDX-License-Identifier: Apache-2.0
// Newton's method on the distance: every step reduces it, and it leaves a crest that the finger is deep below.
#include "app/haptics/method/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <span>

#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};

// A still relief at the scale that a finger feels.
class ClosestPointTest : public testing::Test {
 protected:
  template <class Height>
  void relief(Height&& height) {
    frame_ = test::makeReliefFrame(720, 486, kVolume, {}, height);
    window_ = test::makeWindow(std::span(&frame_, 1), kVolume);
    ASSERT_TRUE(surface_.moveTo(window_, {}));
  }
  double distance(double x, double y, const glm::dvec3& hip) {
    return glm::distance(glm::dvec3(x, y, surface_.height(x, y)), hip);
  }
  Frame frame_;
  SurfaceWindow window_;
  FeltSurface surface_{FeltScale{}};
};

TEST_F(ClosestPointTest, NeverEndsFurtherFromTheFingerThanItBegan) {
  relief([](double x, double y) {
    return 18 + 2 * std::sin(1.3 * x) * std::cos(1.1 * y) + (x > 0.3 * y ? 8 : 0) + 0.2 * std::sin(37 * x + 23 * y);
  });
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-15, 15), aside(-4, 4), deep(0, 9);
  for (int i = 0; i < 3000; ++i) {
    const double x = place(random), y = place(random);
    const glm::dvec3 hip(x + aside(random), y + aside(random), surface_.height(x, y) - deep(random));
    const Contact c = closestPoint(surface_, x, y, hip, 0, SlideUntil::Settled);
    // The last, short step is taken without an evaluation.
    ASSERT_LE(distance(c.x_mm, c.y_mm, hip), distance(x, y, hip) + 0.01) << i;
  }
}

TEST_F(ClosestPointTest, ComesOffACrestThatTheFingerIsDeepUnder) {
  // The crest's radius is 0.75 mm and the finger is 6 mm below it, slightly to one side: the crest is a maximum of the
  // distance, and the way out leads down the side.
  relief([](double x, double) { return 8 + 12 * std::exp(-x * x / 18); });
  for (const double side : {-0.4, 0.4}) {
    const glm::dvec3 hip(side, 3, 14);
    double nearest = 1e9;
    for (double x = 0; x < 8; x += 0.01) nearest = std::min(nearest, distance(std::copysign(x, side), 3, hip));
    Contact c{.x_mm = 0.5 * side, .y_mm = 3};
    for (int tick = 0; tick < 6; ++tick) c = closestPoint(surface_, c.x_mm, c.y_mm, hip, 0, SlideUntil::Settled);
    EXPECT_NEAR(distance(c.x_mm, c.y_mm, hip), nearest, 0.01) << side;
    EXPECT_GT(c.x_mm * side, 0);
  }
}

// On a cylinder of radius r the closest point moves r/(r - depth) times as far as the finger; at depth r the factor is
// unbounded.
TEST_F(ClosestPointTest, ThePredictedStepIsTheFirstOrderAndNoLeap) {
  const auto step = [&](double radius_mm, double deep_mm) {
    const Contact top{.surface = {.z = 20, .zxx = -1 / radius_mm}};
    return predictedStep(top, {0, 0, 20 - deep_mm}, {0.1, 0, 0}, 0);
  };
  EXPECT_NEAR(glm::distance(step(20, 5), glm::dvec2(0.4 / 3, 0)), 0, 1e-9);
  EXPECT_NEAR(glm::distance(step(6, 5), glm::dvec2(0.6, 0)), 0, 1e-9);
  EXPECT_NEAR(glm::distance(step(5.3, 5), glm::dvec2(0.8, 0)), 0, 1e-9) << "the curvature alone would give 17 times";
}

}  // namespace
}  // namespace relievo
