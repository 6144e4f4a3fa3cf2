// SPDX-License-Identifier: Apache-2.0
// The simulated devices on a flat wall, in simulated time: the stiffness at which the loop starts to oscillate,
// compared with theory, and stability in every hand at the stiffness that a device states.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "drivers/sim/profiles.h"

namespace relievo {
namespace {

constexpr double kWallMm = 20, kPushN = 1;

// The heights that the device reports, one per millisecond; the wall's force is its stiffness times the reported depth.
std::vector<double> heightsOn(const DeviceProfile& profile, double stiffness, HandPath path, double seconds) {
  ManualClock clock;
  const auto device = makeSimHaptic(profile, std::move(path), clock);
  EXPECT_TRUE(device->open() && device->home() && device->start());
  const auto ticks_per_ms = static_cast<int>(profile.rate_hz / 1000);
  std::vector<double> heights;
  for (int i = 0; i < static_cast<int>(seconds * profile.rate_hz); ++i) {
    const double z = device->read()->position_mm.z;
    const double force = std::clamp(stiffness * (kWallMm - z), 0.0, profile.peak_force_n);
    EXPECT_TRUE(device->write({0, 0, force}));
    clock.advance(fromSeconds(1 / profile.rate_hz));
    if (i % ticks_per_ms == 0) heights.push_back(z);
  }
  return heights;
}

// The remaining amplitude in each of the last two quarters.
struct Swing {
  double before_mm = 0, last_mm = 0;
};
Swing swingOf(const std::vector<double>& heights) {
  const auto quarter = static_cast<std::ptrdiff_t>(heights.size() / 4);
  const auto between = [](auto begin, auto end) {
    const auto [low, high] = std::minmax_element(begin, end);
    return *high - *low;
  };
  return {between(heights.end() - 2 * quarter, heights.end() - quarter),
          between(heights.end() - quarter, heights.end())};
}

// The device alone, pushed onto the wall with 1 N by a long soft spring that does not hold it, and released at a given
// distance from its rest.
Swing swingAlone(DeviceProfile profile, double stiffness, double off_mm) {
  profile.hand = {.mass_kg = 0, .stiffness_n_per_mm = kPushN / 100, .damping_n_s_per_mm = 0};
  const double rest_mm = kWallMm - kPushN / stiffness;
  const HandPath path({{0.0, {0, 0, rest_mm + off_mm}}, {0.001, {0, 0, rest_mm - 100}}});
  return swingOf(heightsOn(profile, stiffness, path, 2));
}

DeviceProfile withoutDryFriction(DeviceProfile profile) {
  profile.coulomb_friction_n = 0;
  profile.encoder_step_mm = 0;
  return profile;
}

// By bisection, to 0.5 %.
double onsetOf(const DeviceProfile& profile) {
  double rests = 0, swings = 3 * profile.viscousBound();
  while (swings - rests > 0.005 * swings) {
    const double stiffness = 0.5 * (rests + swings);
    const double off_mm = 0.2 * kPushN / stiffness;  // it does not leave the wall
    const Swing swing = swingAlone(profile, stiffness, off_mm);
    const bool on = swing.last_mm > 2.2 * off_mm || (swing.last_mm > 1e-4 && swing.last_mm >= swing.before_mm);
    (on ? swings : rests) = stiffness;
  }
  return rests;
}

struct Loop {
  const char* device;
  double rate_hz;
  int delay_ticks;
};
void PrintTo(const Loop& loop, std::ostream* out) {
  *out << loop.device << " at " << loop.rate_hz << " Hz, " << loop.delay_ticks << " ticks late";
}
DeviceProfile profileOf(const Loop& loop) {
  DeviceProfile profile;
  for (const SimDeviceName& named : simDevices()) {
    if (std::string_view(named.word) == loop.device) profile = named.profile;
  }
  profile.rate_hz = loop.rate_hz;
  profile.delay_ticks = loop.delay_ticks;
  return profile;
}
std::vector<Loop> loops() {
  std::vector<Loop> all;
  for (const SimDeviceName& named : simDevices()) {
    for (const double rate_hz : {1000.0, 4000.0}) {
      for (const int delay_ticks : {0, 1, 2, 3}) all.push_back({named.word, rate_hz, delay_ticks});
    }
  }
  return all;
}

class SimLoop : public testing::TestWithParam<Loop> {};
INSTANTIATE_TEST_SUITE_P(Devices, SimLoop, testing::ValuesIn(loops()));

TEST_P(SimLoop, WithoutDryFrictionItSwingsFromTheViscousBoundOn) {
  const DeviceProfile profile = withoutDryFriction(profileOf(GetParam()));
  const double late_ticks = 0.5 + GetParam().delay_ticks;
  const double bound = profile.damping_n_s_per_mm * GetParam().rate_hz / late_ticks;
  EXPECT_NEAR(profile.viscousBound(), bound, 1e-9);
  const double onset = onsetOf(profile);
  RecordProperty("onset_n_per_mm", std::to_string(onset));
  RecordProperty("bound_n_per_mm", std::to_string(bound));
  EXPECT_NEAR(onset, bound, 0.2 * bound);
}

TEST_P(SimLoop, WithFrictionAndEncoderItRestsUpToFourFifthsOfTheBounds) {
  const DeviceProfile profile = profileOf(GetParam());
  const double bound = std::min(profile.viscousBound(), 2 * profile.coulomb_friction_n / profile.encoder_step_mm);
  for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {
    EXPECT_LE(swingAlone(profile, share * bound, 1.0).last_mm, profile.encoder_step_mm) << share << " of " << bound;
  }
}

TEST(SimStability, FarAboveTheBoundsItSwings) {
  const DeviceProfile phantom = simDevices()[0].profile;
  const double bound = std::min(phantom.viscousBound(), phantom.frictionBound());
  EXPECT_GT(swingAlone(phantom, 2 * bound, 1.0).last_mm, 1.0);
}

// A random delay of up to a tick is half a tick on average; the bound assumes the whole tick.
TEST(SimStability, JitterLowersTheOnsetAndTheBoundMore) {
  for (const double jitter_ticks : {0.5, 1.0}) {
    DeviceProfile profile = withoutDryFriction(simDevices()[0].profile);
    profile.jitter_ticks = jitter_ticks;
    const double on_average =
        profile.damping_n_s_per_mm * profile.rate_hz / (0.5 + profile.delay_ticks + jitter_ticks / 2);
    const double onset = onsetOf(profile);
    EXPECT_NEAR(onset, on_average, 0.1 * on_average) << jitter_ticks;
    EXPECT_GT(onset, profile.viscousBound()) << jitter_ticks;
  }
}

// With every hand, at the highest stiffness that the device states: delay and encoder do not change how it moves, and a
// hand at rest stays at rest.
TEST(SimStability, WhatADevicePromisesItHoldsInEveryHand) {
  for (const SimDeviceName& device : simDevices()) {
    for (const SimHandName& hand : simHands()) {
      for (const double jitter_ticks : {0.0, 1.0}) {
        SCOPED_TRACE(testing::Message() << device.word << ", " << hand.word << ", jitter " << jitter_ticks);
        DeviceProfile real = device.profile;
        real.hand = hand.hand;
        real.jitter_ticks = jitter_ticks;
        ManualClock clock;
        const double stiffness = makeSimHaptic(real, HandPath(), clock)->capabilities().max_stiffness_n_per_mm;
        EXPECT_GE(stiffness, 0.4) << "no less than a touch needs";
        DeviceProfile ideal = real;
        ideal.encoder_step_mm = 0, ideal.delay_ticks = 0, ideal.jitter_ticks = 0, ideal.rate_hz = 8000;

        const auto heights = heightsOn(real, stiffness, HandPath(hand.motion), 6);
        const auto wished = heightsOn(ideal, stiffness, HandPath(hand.motion), 6);
        double off = 0;
        for (std::size_t i = 0; i < heights.size(); ++i) off = std::max(off, std::abs(heights[i] - wished[i]));
        EXPECT_LT(off, hand.motion == HandMotion::Tapping ? 1.0 : 0.2);
        const bool still = hand.motion == HandMotion::Resting || hand.motion == HandMotion::Pressing;
        EXPECT_TRUE(!still || swingOf(heights).last_mm <= real.encoder_step_mm) << swingOf(heights).last_mm;
      }
    }
  }
}

// The spring of a stiffening hand adds to the wall's. The hand holds its position instead of pressing.
TEST(SimStability, WhatADevicePromisesItHoldsOnAnySpring) {
  for (const SimDeviceName& device : simDevices()) {
    for (const double hand_stiffness : {0.05, 0.3, 1.0, 2.0, 4.0}) {
      SCOPED_TRACE(testing::Message() << device.word << ", " << hand_stiffness);
      DeviceProfile profile = device.profile;
      profile.hand = {.mass_kg = 0.02, .stiffness_n_per_mm = hand_stiffness, .damping_n_s_per_mm = 0};
      ManualClock clock;
      const double stiffness = makeSimHaptic(profile, HandPath(), clock)->capabilities().max_stiffness_n_per_mm;
      const double rest = kWallMm - kPushN / stiffness;
      const HandPath path({{0.0, {0, 0, rest + 0.3}}, {0.001, {0, 0, rest - kPushN / hand_stiffness}}});
      EXPECT_LE(swingOf(heightsOn(profile, stiffness, path, 2)).last_mm, profile.encoder_step_mm);
    }
  }
}

}  // namespace
}  // namespace relievo
