// SPDX-License-Identifier: Apache-2.0
// Limits, fades, energy accounts and methods at every rate of the task: each takes the same time at every rate.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/haptics/baseline/methods.h"
#include "app/haptics/method/relievo_method.h"
#include "app/haptics/task/haptic_task.h"
#include "app/haptics/task/safety.h"
#include "tests/support/device/fake_haptic_device.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
constexpr DisplayVolume kVolume{160, 108, 40};
constexpr double kStiffness = 0.5;

class TouchRate : public testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static double tickS() { return 1.0 / GetParam(); }
  [[nodiscard]] static int ticksIn(double seconds) { return static_cast<int>(std::lround(seconds * GetParam())); }
};
INSTANTIATE_TEST_SUITE_P(Hz, TouchRate, testing::Values(500, 1000, 2000, 4000, 8000));

TEST_P(TouchRate, TheScenesForceComesAtFiftyNewtonsPerSecond) {
  SafetyFilter filter({}, kStiffness);
  for (int i = 1; i <= ticksIn(0.03); ++i) {
    const double expected = std::min(1.0, 50.0 * i / GetParam());
    ASSERT_NEAR(filter.apply({0, 0, 1}, glm::dvec3(0), tickS()).z, expected, 1e-9) << i;
  }
}

// From 5 N to a wanted 0 N: the force falls by 50 N/s, and by 200 N/s more because the hand moves out at 400 mm/s
// against 0.5 N/mm, so that it takes 20 ms. Meanwhile the hand moves 8 mm at 2.5 N on average: 20 mJ, all that the tank
// has. At 500 Hz it is 3 less, since the force at the end of each tick counts. The tank is refilled by 10 mJ/s, and the
// share of the force is twice the share that the tank is full: it rises by half in 0.5 s and is whole after 1 s.
TEST_P(TouchRate, TheTankIsEmptiedByALagAndRefilledInTheSameSeconds) {
  SafetyFilter filter({}, kStiffness);
  for (int i = 0; i < ticksIn(0.2); ++i) static_cast<void>(filter.apply({0, 0, 5}, glm::dvec3(0), tickS()));
  double z = 0;
  for (int i = 0; i < ticksIn(0.04); ++i, z += 400 * tickS()) {
    static_cast<void>(filter.apply(glm::dvec3(0), {0, 0, z}, tickS()));
  }
  const double left = filter.share();
  for (int i = 0; i < ticksIn(0.5); ++i) static_cast<void>(filter.apply(glm::dvec3(0), {0, 0, z}, tickS()));
  EXPECT_LT(left, 0.35);
  EXPECT_NEAR(filter.share() - left, 0.5, 1e-6);
  for (int i = 0; i < ticksIn(0.6); ++i) static_cast<void>(filter.apply(glm::dvec3(0), {0, 0, z}, tickS()));
  EXPECT_EQ(filter.share(), 1);
}

// In and out of a wall, 5 mm deep, at up to 0.3 m/s: what is held does no work beyond a spring's.
TEST_P(TouchRate, AStrokeOnAWallGivesTheHandNoEnergy) {
  SafetyFilter filter({}, kStiffness);
  const int ticks = ticksIn(0.05236);  // 5 mm x pi/(0.3 m/s)
  double work = 0, z = 0, force = filter.apply({}, {0, 0, 0}, tickS()).z;
  for (int i = 1; i <= 4 * ticks; ++i) {
    const double next = -2.5 * (1 - std::cos(2 * std::numbers::pi * i / ticks));
    work += force * (next - z);
    z = next;
    force = filter.apply({0, 0, -kStiffness * z}, {0, 0, z}, tickS()).z;
  }
  EXPECT_LE(work, 0.01) << "mJ";
  EXPECT_LE(filter.books().artefactMj(), 0.01);
}

class TouchRateOfTask : public TouchRate {
 protected:
  void SetUp() override { ASSERT_TRUE(device_.open() && device_.home() && device_.start()); }
  void tick(int n = 1) {
    for (int i = 0; i < n; ++i) {
      clock_.advance(fromSeconds(tickS()));
      ASSERT_EQ(task_.loop({index_++, clock_.now(), clock_.now()}), LoopControl::Continue);
    }
  }
  ManualClock clock_{MonotonicTime{} + 5s};
  test::FakeHapticDevice device_;
  std::unique_ptr<TouchMethod> method_ = makeMethod("relievo", {.stiffness_n_per_mm = kStiffness, .tick_s = tickS()});
  HapticTask task_{device_, *method_, clock_, kVolume, SafetyLimits{}, kStiffness};
  std::uint64_t index_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Hz, TouchRateOfTask, testing::Values(500, 1000, 2000, 4000, 8000));

// A plane at 20 mm with one picture, pressed 1 mm deep: 0.5 N. It is late 50 ms after its picture, and gone 10 ms
// later.
TEST_P(TouchRateOfTask, DepthThatIsLateIsToldAfterFiftyMillisecondsAndFadesInTen) {
  SurfaceWindow& window = task_.windowToFill();
  const std::vector frames{test::makeReliefFrame(40, 30, kVolume, {}, [](double, double) { return 20.0; })};
  window = test::makeWindow(frames, kVolume);
  window.clock = {.media = {}, .monotonic = clock_.now(), .rate = 1};
  task_.publishWindow();
  device_.position = {0, 0, 0.1};
  tick();
  device_.position = {0, 0, -1};
  tick(ticksIn(0.05) - 1);
  EXPECT_NEAR(device_.force.z, 0.5, 0.01);
  EXPECT_FALSE(task_.nextFault());
  tick();
  ASSERT_TRUE(task_.nextFault());
  EXPECT_NEAR(device_.force.z, 0.5 - 50 * tickS(), 0.01);
  tick(ticksIn(0.006) - 1);
  EXPECT_NEAR(device_.force.z, 0.2, 0.01);
  tick(ticksIn(0.004));
  EXPECT_NEAR(device_.force.z, 0, 0.01);
}

// A finger 2 mm deep in a plane is left 2 mm deep at the cut to one that is 16 mm higher. When it has lifted by 1 mm,
// the lowered surface follows at 100 mm/s: 0.4 mm and 0.2 N in 4 ms.
TEST_P(TouchRate, ALoweredSurfaceRisesBackInTheSameTime) {
  const auto plane = [](double height, std::uint32_t epoch) {
    const std::vector frames{test::makeReliefFrame(40, 30, kVolume, {}, [&](double, double) { return height; })};
    SurfaceWindow window = test::makeWindow(frames, kVolume);
    window.epoch = epoch;
    return window;
  };
  const auto method = makeMethod("relievo", {.stiffness_n_per_mm = kStiffness, .tick_s = tickS()});
  const SurfaceWindow low = plane(12, 0), high = plane(28, 1);
  static_cast<void>(method->update({0, 0, 13}, low, {}));
  ASSERT_NEAR(method->update({0, 0, 10}, low, {}).force_n.z, 1, 1e-3);
  ASSERT_NEAR(method->update({0, 0, 10}, high, {}).force_n.z, 1, 1e-3);
  double force = 0;
  for (int i = 0; i <= ticksIn(0.004); ++i) force = method->update({0, 0, 11}, high, {}).force_n.z;
  EXPECT_NEAR(force, 0.7, 1e-3);
}

}  // namespace
}  // namespace relievo
