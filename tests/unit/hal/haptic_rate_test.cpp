// SPDX-License-Identifier: Apache-2.0
// The rate of a haptic device: who may set it, what a device makes of it, and the stiffness that stays stable.
#include "hal/haptic_rate.h"

#include <gtest/gtest.h>

#include <limits>

#include "drivers/mock/mock.h"
#include "hal/device_profile.h"

namespace relievo {
namespace {

std::unique_ptr<HapticDevice> device(double most_hz, Clock& clock) {
  MockHapticProfile profile;
  profile.capabilities.max_stiffness_n_per_mm = 0.8;
  profile.most_rate_hz = most_hz;
  return makeMockHaptic(profile, clock);
}

TEST(HapticRate, IsTheDevicesOwnUntilItIsAskedForAndThenTheMostThatItCan) {
  ManualClock clock;
  for (const auto& [asked, gets] : {std::pair{500.0, 500.0}, {1000.0, 1000.0}, {3999.0, 3999.0}, {8000.0, 4000.0}}) {
    const auto one = device(4000, clock);
    EXPECT_EQ(one->capabilities().rate_hz, 1000);
    EXPECT_EQ(one->setRate(asked).value(), gets);
    EXPECT_EQ(one->capabilities().rate_hz, gets);
    ASSERT_TRUE(one->open() && one->home() && one->start());
    one->close();
    EXPECT_EQ(one->capabilities().rate_hz, gets) << "also when it comes back";
  }
}

TEST(HapticRate, IsSetOnlyBeforeTheDeviceIsOpenedAndWithinItsBounds) {
  ManualClock clock;
  const auto one = device(4000, clock);
  for (const double wrong : {0.0, -1.0, 499.9, 8000.1, std::numeric_limits<double>::quiet_NaN()}) {
    const auto set = one->setRate(wrong);
    ASSERT_FALSE(set) << wrong;
    EXPECT_EQ(set.error().code, ErrorCode::InvalidArgument);
  }
  ASSERT_TRUE(one->open());
  EXPECT_EQ(one->setRate(500).error().code, ErrorCode::InvalidState);
  EXPECT_EQ(one->capabilities().rate_hz, 1000);
}

// Half the rate: half of 2b/T. Four times the rate: 4^(ln(0.904/0.325)/ln(160)) = 4^0.20157 = 1.3224.
TEST(HapticRate, TheStableStiffnessFollowsTheoryDownAndWhatWasMeasuredUp) {
  EXPECT_NEAR(perceivedOnset(250), 0.325, 1e-12);
  EXPECT_NEAR(perceivedOnset(40'000), 0.904, 1e-12);
  EXPECT_EQ(stiffnessAtRate(0.8, 1000, 1000), 0.8);
  EXPECT_NEAR(stiffnessAtRate(0.8, 1000, 500), 0.4, 1e-12);
  EXPECT_NEAR(stiffnessAtRate(0.8, 1000, 4000), 0.8 * 1.3224, 1e-4);
  ManualClock clock;
  for (const auto& [hz, stiffness] : {std::pair{500.0, 0.4}, {1000.0, 0.8}, {4000.0, 1.0579}}) {
    const auto one = device(8000, clock);
    ASSERT_TRUE(one->setRate(hz));
    EXPECT_NEAR(one->capabilities().max_stiffness_n_per_mm, stiffness, 1e-4) << hz;
  }
}

// b > K T/2 + |B| with B = 0 and a force that is n ticks late: K = 2 b/((1 + 2 n) T), here 2 x 0.002/(3 T).
TEST(HapticRate, NeverClaimsMoreThanTheLawOfTheDevicesDamping) {
  DeviceProfile profile;
  ASSERT_NEAR(profile.viscousBound(), 4.0 / 3, 1e-12);
  for (const double hz : {500.0, 2000.0, 8000.0}) {
    DeviceProfile other = profile;
    other.rate_hz = hz;
    EXPECT_LE(stiffnessAtRate(profile.viscousBound(), 1000, hz), other.viscousBound() * (1 + 1e-12)) << hz;
    EXPECT_EQ(other.frictionBound(), profile.frictionBound());
  }
}

}  // namespace
}  // namespace relievo
