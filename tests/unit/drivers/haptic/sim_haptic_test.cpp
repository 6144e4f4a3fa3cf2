// SPDX-License-Identifier: Apache-2.0
// The simulated device's positions and forces tick by tick, in simulated time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <vector>

#include "drivers/sim/profiles.h"
#include "drivers/sim/sim.h"
#include "platform/allocation_counter.h"

namespace relievo {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(1);

HandPath stillAt(const glm::dvec3& position_mm) {
  return HandPath({{0.0, position_mm}});
}

// A device without a hand, without friction and with exact positions.
DeviceProfile freeMass() {
  DeviceProfile profile;
  profile.damping_n_s_per_mm = 0;
  profile.coulomb_friction_n = 0;
  profile.encoder_step_mm = 0;
  profile.delay_ticks = 0;
  profile.peak_force_n = 1000;
  profile.hand = {.mass_kg = 0, .stiffness_n_per_mm = 0, .damping_n_s_per_mm = 0};
  return profile;
}

struct Bench {
  explicit Bench(const DeviceProfile& profile, HandPath path = stillAt({0, 0, 20}))
      : device(makeSimHaptic(profile, std::move(path), clock)) {
    EXPECT_TRUE(device->open() && device->home() && device->start());
  }
  glm::dvec3 read() {
    const auto sample = device->read();
    EXPECT_TRUE(sample);
    return sample ? sample->position_mm : glm::dvec3(0);
  }
  // Reads the position, writes `force` of it, and advances by a tick; returns the position.
  glm::dvec3 tick(const std::function<glm::dvec3(const glm::dvec3&)>& force) {
    const glm::dvec3 position = read();
    EXPECT_TRUE(device->write(force(position)));
    clock.advance(kTick);
    return position;
  }

  ManualClock clock;
  std::unique_ptr<HapticDevice> device;
};

TEST(SimHaptic, TellsWholeEncoderStepsOfTheTruePosition) {
  DeviceProfile exact, coarse;
  exact.encoder_step_mm = 0;
  coarse.encoder_step_mm = 0.5;
  Bench a(exact, HandPath()), b(coarse, HandPath());
  double largest_error = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto none = [](const glm::dvec3&) { return glm::dvec3(0); };
    const glm::dvec3 difference = b.tick(none) - a.tick(none);
    const glm::dvec3 read = b.read() / 0.5;
    ASSERT_EQ(read.x, std::round(read.x));
    ASSERT_EQ(read.z, std::round(read.z));
    for (int axis = 0; axis < 3; ++axis) largest_error = std::max(largest_error, std::abs(difference[axis]));
  }
  EXPECT_LE(largest_error, 0.25 + 1e-9);
  EXPECT_GT(largest_error, 0.2);
}

class SimHapticDelay : public testing::TestWithParam<int> {};

// One tick of 1 N on 0.075 kg leaves 13.333 mm/s, that is 13.333 um a tick, from the (n+1)th tick on.
TEST_P(SimHapticDelay, AForceIsHeldForOneTickAfterSoManyTicks) {
  DeviceProfile profile = freeMass();
  profile.delay_ticks = GetParam();
  Bench bench(profile);
  double before = 0;
  for (int i = 0; i < 12; ++i) {
    const double x = bench.tick([&](const glm::dvec3&) { return glm::dvec3(i == 0 ? 1.0 : 0.0, 0, 0); }).x;
    const double moved_um = 1e3 * (x - before);
    if (i <= GetParam()) {
      EXPECT_EQ(moved_um, 0.0) << i;
    } else if (i == GetParam() + 1) {
      EXPECT_NEAR(moved_um, 6.667, 1e-3) << "v T/2: the speed rises over the tick";
    } else {
      EXPECT_NEAR(moved_um, 13.333, 1e-3) << i;
    }
    before = x;
  }
}
INSTANTIATE_TEST_SUITE_P(Ticks, SimHapticDelay, testing::Values(0, 1, 3, 8));

// 1 N on 0.075 kg for four ticks leaves 53.333 um a tick; it begins late by one share of a tick and ends late by
// another.
TEST(SimHaptic, JitterMovesAForceWithinATick) {
  DeviceProfile profile = freeMass();
  profile.delay_ticks = 1;
  profile.jitter_ticks = 1;
  double earliest = 1, latest = 0, shortest = 1, longest = -1;  // ticks
  for (int seed = 0; seed < 200; ++seed) {
    profile.jitter_seed = static_cast<std::uint64_t>(seed);
    Bench bench(profile);
    std::vector<double> x;  // um
    for (int i = 0; i < 8; ++i) {
      x.push_back(1e3 * bench.tick([&](const glm::dvec3&) { return glm::dvec3(i < 4 ? 1.0 : 0.0, 0, 0); }).x);
    }
    ASSERT_EQ(x[1], 0.0);
    const double late = 1 - std::sqrt(x[2] / 6.6667);  // it moves the mass by (1 - late)^2 6.667 um in its first tick
    const double longer = (x[7] - x[6]) / 13.3333 - 4;
    earliest = std::min(earliest, late), latest = std::max(latest, late);
    shortest = std::min(shortest, longer), longest = std::max(longest, longer);
  }
  EXPECT_LT(earliest, 0.1);
  EXPECT_GT(latest, 0.9);
  EXPECT_NEAR(shortest, -0.9, 0.1);
  EXPECT_NEAR(longest, 0.9, 0.1);
}

TEST(SimHaptic, JitterIsOffByDefaultAndOneSeedIsOneRun) {
  EXPECT_EQ(DeviceProfile{}.jitter_ticks, 0);
  DeviceProfile profile, other;
  profile.jitter_ticks = other.jitter_ticks = 1;
  other.jitter_seed = 2;
  Bench a(profile, HandPath()), b(profile, HandPath()), c(other, HandPath());
  bool differs = false;
  for (int i = 0; i < 3000; ++i) {
    const auto wall = [](const glm::dvec3& p) { return glm::dvec3(0, 0, std::clamp(20 - p.z, 0.0, 8.0)); };
    const glm::dvec3 at = a.tick(wall);
    ASSERT_EQ(at, b.tick(wall));
    differs = differs || at != c.tick(wall);
  }
  EXPECT_TRUE(differs);
}

struct WallCase {
  int delay_ticks;
  double of_bound;
};
void PrintTo(const WallCase& wall, std::ostream* out) {
  *out << wall.of_bound << " of the bound, " << wall.delay_ticks << " ticks of delay";
}
class SimHapticWall : public testing::TestWithParam<WallCase> {};

// A spring K whose force is t late is K - K t s to first order in t: a spring and a damper of -K t. The force
// held over a tick is half a tick late on average, and the delay adds n T: t = (1/2 + n) T. The device's own
// damping b outweighs it while b > K (1/2 + n) T, that is K < 2 b/((1 + 2 n) T). The neglected terms,
// (w t)^2/6 with w = sqrt(K/m), are under 2 % at the bound.
TEST_P(SimHapticWall, IsStableBelowTheClassicBoundAndNotAbove) {
  const auto [delay_ticks, of_bound] = GetParam();
  DeviceProfile profile = freeMass();
  profile.damping_n_s_per_mm = 0.002;
  profile.delay_ticks = delay_ticks;
  const double bound_n_per_mm = 2 * 0.002 / ((1 + 2 * delay_ticks) * 0.001);
  Bench bench(profile, stillAt({0.01, 0, 20}));
  EXPECT_NEAR(profile.viscousBound(), bound_n_per_mm, 1e-12);

  const double stiffness = of_bound * bound_n_per_mm;
  double first_swing = 0, last_swing = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = bench.tick([&](const glm::dvec3& p) { return glm::dvec3(-stiffness * p.x, 0, 0); }).x;
    if (i < 100) first_swing = std::max(first_swing, std::abs(x));
    if (i >= 900) last_swing = std::max(last_swing, std::abs(x));
  }
  if (of_bound < 1) {
    EXPECT_LT(last_swing, first_swing);
  } else {
    EXPECT_GT(last_swing, first_swing);
  }
  // The swing goes as exp((K t - b) s/(2 m)), that is 13.3 (K/bound - 1) in 1 s, here over the 0.9 s between
  // the middles of the two spans, less 15 % for the neglected terms; and each span's largest swing is up to a
  // tenth of it off.
  const double exponent = 13.33 * 0.9 * (of_bound - 1);
  EXPECT_NEAR(std::log(last_swing / first_swing), exponent, 0.15 * std::abs(exponent) + 0.1);
}
INSTANTIATE_TEST_SUITE_P(Bound, SimHapticWall,
                         testing::Values(WallCase{0, 0.5}, WallCase{0, 0.85}, WallCase{0, 1.15}, WallCase{0, 1.5},
                                         WallCase{1, 0.5}, WallCase{1, 0.85}, WallCase{1, 1.15}, WallCase{1, 1.5},
                                         WallCase{3, 0.5}, WallCase{3, 0.85}, WallCase{3, 1.15}, WallCase{3, 1.5}));

// Spring and mass at rest: the hand's 0.3 N/mm pulled by 0.9 N yields by 3 mm, minus what friction absorbs
// (0.04 N / 0.3 N/mm = 0.13 mm).
TEST(SimHaptic, TheHandGivesWayAsASpring) {
  Bench bench(DeviceProfile{});
  glm::dvec3 position{0};
  for (int i = 0; i < 2000; ++i) position = bench.tick([](const glm::dvec3&) { return glm::dvec3(0, 0.9, 0); });
  EXPECT_NEAR(position.y, 3.0, 0.14 + 0.015);
}

// A spring and damper pull a frictionless mass along with a steadily moving point, without lag, since the damper is at
// rest. One tick of delay would be 100 um.
TEST(SimHaptic, TheHandKeepsUpWithItsPath) {
  DeviceProfile profile = freeMass();
  profile.hand = HandProfile{};
  Bench bench(profile, HandPath({{0.0, {-50, 0, 20}}, {1.0, {50, 0, 20}}}));
  glm::dvec3 position{0};
  for (int i = 0; i <= 900; ++i) position = bench.tick([](const glm::dvec3&) { return glm::dvec3(0); });
  EXPECT_NEAR(position.x, 40.0, 1e-4);
}

class SimHapticTouch : public testing::TestWithParam<double> {};

TEST_P(SimHapticTouch, TheStrokingHandPressesGentlyWhereverTheSurfaceIs) {
  Bench bench(DeviceProfile{}, HandPath());
  double least = 1e9, most = 0, left = 0, right = 0, low = 0, high = 0, last_z = 0;
  for (int i = 0; i < 35'000; ++i) {
    double force = 0;
    const glm::dvec3 p = bench.tick([&](const glm::dvec3& at) {
      force = std::max(0.0, 0.5 * (GetParam() - at.z));
      return glm::dvec3(0, 0, force);
    });
    const int in_round_ms = (i - 500) % 4'000;
    if (in_round_ms > 2'000 && in_round_ms < 2'800) {
      least = std::min(least, force);
      most = std::max(most, force);
      left = std::min(left, p.x), right = std::max(right, p.x);
      low = std::min(low, p.y), high = std::max(high, p.y);
    }
    if (i == 4'499) last_z = p.z;
  }
  EXPECT_GT(least, 0.8);
  EXPECT_LT(most, 2.2);
  EXPECT_GT(last_z, 44.0) << "it lifts between two strokes, beyond the nearest surface";
  EXPECT_LT(left, -40.0);
  EXPECT_GT(right, 40.0);
  EXPECT_LT(low, -25.0);
  EXPECT_GT(high, 25.0);
}
INSTANTIATE_TEST_SUITE_P(Surfaces, SimHapticTouch, testing::Values(0.0, 20.0, 40.0));

TEST(SimHaptic, RunsAlikeToTheLastBit) {
  Bench a(DeviceProfile{}, HandPath()), b(DeviceProfile{}, HandPath());
  for (int i = 0; i < 3000; ++i) {
    const auto wall = [](const glm::dvec3& p) { return glm::dvec3(0, 0, std::max(0.0, 20 - p.z)); };
    ASSERT_EQ(a.tick(wall), b.tick(wall));
  }
}

TEST(SimHaptic, AGapMovesItByTwentyMillisecondsAtMost) {
  Bench late(DeviceProfile{}, HandPath()), punctual(DeviceProfile{}, HandPath());
  const auto none = [](const glm::dvec3&) { return glm::dvec3(0); };
  for (int i = 0; i < 1000; ++i) late.tick(none), punctual.tick(none);
  (void)late.read(), (void)punctual.read();
  late.clock.advance(std::chrono::seconds(5));
  punctual.clock.advance(std::chrono::milliseconds(20));
  EXPECT_EQ(late.read(), punctual.read());
}

TEST(SimHaptic, AForceThatIsNotRenewedEnds) {
  Bench bench(freeMass());
  bench.tick([](const glm::dvec3&) { return glm::dvec3(1, 0, 0); });
  bench.clock.advance(std::chrono::milliseconds(100));
  const double first = bench.read().x;
  bench.clock.advance(kTick);
  const double second = bench.read().x;
  bench.clock.advance(kTick);
  EXPECT_NEAR(bench.read().x - second, second - first, 1e-9) << "it goes on, but is no longer pushed";
}

TEST(SimHaptic, StopsAtTheEndOfItsWorkspace) {
  Bench bench(freeMass());
  glm::dvec3 position{0};
  for (int i = 0; i < 500; ++i) position = bench.tick([](const glm::dvec3&) { return glm::dvec3(0, 0, 1); });
  EXPECT_EQ(position, glm::dvec3(0, 0, 80));
  for (int i = 0; i < 100; ++i) position = bench.tick([](const glm::dvec3&) { return glm::dvec3(0, 0, -1); });
  // 99 ticks at 13.33 m/s^2 from rest, to 14.7 mm (65.3 mm lower): the stop has left no speed. The rest is the
  // integration's error.
  EXPECT_NEAR(position.z, 80 - 0.5 * 13'333.3 * 0.099 * 0.099, 0.05);
}

TEST(SimHaptic, ATickAllocatesNothing) {
  Bench bench(DeviceProfile{}, HandPath());
  bench.tick([](const glm::dvec3&) { return glm::dvec3(0); });
  const std::uint64_t before = threadAllocations();
  for (int i = 0; i < 100; ++i) {
    (void)bench.device->read();
    (void)bench.device->write({0, 0, 1});
    bench.clock.advance(kTick);
  }
  EXPECT_EQ(threadAllocations(), before);
}

TEST(SimHaptic, RefusesAProfileThatCannotMove) {
  DeviceProfile profile;
  profile.moving_mass_kg = 0;
  ManualClock clock;
  const auto opened = makeSimHaptic(profile, HandPath(), clock)->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::InvalidArgument);
}

// One newton on 0.075 kg: 0.5 x 13.333 mm/s x t/ms, that is 66.7 mm after 0.1 s, at every rate. Where the mass's own
// friction is b = 0.002 N s/mm and a force comes one tick late, a wall swings from a stiffness of 2 b/(3 T) on. The
// device reports 0.8 of that as its highest stiffness.
TEST(SimHaptic, AnotherRateIsTheSameMotionAndAnotherStiffness) {
  for (const double hz : {500.0, 1000.0, 2000.0, 8000.0}) {
    ManualClock clock;
    const auto device = makeSimHaptic(freeMass(), stillAt({0, 0, 0}), clock);
    ASSERT_EQ(device->setRate(hz).value(), hz);
    ASSERT_TRUE(device->open() && device->home() && device->start());
    for (int i = 0; i < static_cast<int>(0.1 * hz); ++i) {
      ASSERT_TRUE(device->read() && device->write({1, 0, 0}));
      clock.advance(fromSeconds(1 / hz));
    }
    EXPECT_NEAR(device->read()->position_mm.x, 66.667, 0.01) << hz;

    DeviceProfile profile;
    profile.coulomb_friction_n = 10;  // the encoder's bound is far
    const auto stiff = makeSimHaptic(profile, stillAt({0, 0, 0}), clock);
    ASSERT_TRUE(stiff->setRate(hz));
    EXPECT_NEAR(stiff->capabilities().max_stiffness_n_per_mm, std::min(0.8 * 2 * 0.002 / 3 * hz, 3.5), 1e-9) << hz;
  }
}

TEST(SimHaptic, AsAFalconItCannotTickFasterThanAFalcon) {
  ManualClock clock;
  const auto device = makeSimHaptic(parseSim("falcon")->profile, stillAt({0, 0, 0}), clock);
  EXPECT_EQ(device->setRate(4000).value(), 1000);
}

}  // namespace
}  // namespace relievo
