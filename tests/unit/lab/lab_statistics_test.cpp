// SPDX-License-Identifier: Apache-2.0
// Force errors and spreads of times, against figures worked out by hand.
#include "app/lab/numbers/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace relievo {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(ForceError, OfATurnedForceIsTheChordOfTheAngle) {
  ForceErrorSum sum;
  sum.add({2 * std::sin(10 * kDegree), 0, 2 * std::cos(10 * kDegree)}, true, {0, 0, 2}, true);
  const ForceError e = sum.result();
  EXPECT_NEAR(e.rms_n, 4 * std::sin(5 * kDegree), 1e-12);
  EXPECT_NEAR(e.rms_percent, 200 * std::sin(5 * kDegree), 1e-10);
  EXPECT_NEAR(e.direction_rms_deg, 10, 1e-10);
  EXPECT_NEAR(e.magnitude_rms_percent, 0, 1e-10);
}

TEST(ForceError, OfATooWeakForceHasNoAngle) {
  ForceErrorSum sum;
  sum.add({0, 0.3, 0.4}, true, {0, 0.6, 0.8}, true);
  const ForceError e = sum.result();
  EXPECT_NEAR(e.rms_n, 0.5, 1e-12);
  EXPECT_NEAR(e.rms_percent, 50, 1e-10);
  EXPECT_NEAR(e.magnitude_rms_percent, 50, 1e-10);
  EXPECT_NEAR(e.direction_rms_deg, 0, 1e-10);
}

TEST(ForceError, OfALostContactIsTheWholeForceWhateverTheMethodSays) {
  ForceErrorSum sum;
  sum.add({0, 0, 2}, true, {0, 0, 2}, true);
  sum.add({5, 0, 0}, false, {0, 0, 2}, true);
  const ForceError e = sum.result();
  EXPECT_EQ(e.ticks, 2u);
  EXPECT_EQ(e.lost_ticks, 1u);
  EXPECT_NEAR(e.rms_percent, 100 / std::numbers::sqrt2, 1e-10);
  EXPECT_NEAR(e.direction_rms_deg, 0, 1e-10);
}

TEST(ForceError, DoesNotCountWhereThereIsNoContactInTruth) {
  ForceErrorSum sum;
  sum.add({0, 0, 9}, true, {0, 0, 0}, false);
  EXPECT_EQ(sum.result().ticks, 0u);
  EXPECT_EQ(sum.result().rms_n, 0);
}

TEST(ForceError, OfTwoRunsTogetherWeighsTheirTicks) {
  ForceErrorSum first, second;
  for (int i = 0; i < 3; ++i) first.add({0, 0, 2}, true, {0, 0, 2}, true);
  second.add({1, 0, 0}, false, {0, 0, 2}, true);
  second.add({0, 2, 0}, true, {0, 0, 2}, true);
  second.add({0, 0, 1}, true, {0, 0, 2}, true);
  first.add(second);
  const ForceError e = first.result();
  EXPECT_EQ(e.ticks, 6u);
  EXPECT_EQ(e.lost_ticks, 1u);
  EXPECT_NEAR(e.rms_n, std::sqrt((4 + 8 + 1) / 6.0), 1e-12);
  EXPECT_NEAR(e.rms_percent, 100 * std::sqrt((4 + 8 + 1) / 24.0), 1e-10);
  EXPECT_NEAR(e.direction_rms_deg, std::sqrt(90.0 * 90 / 5), 1e-10);
  EXPECT_NEAR(e.magnitude_rms_percent, 100 * std::sqrt((4 + 0 + 1) / 24.0), 1e-10);
}

TEST(ForceError, ContactIsLostWhereItIsInMoreThanAHundredthOfTheTicks) {
  EXPECT_FALSE((ForceError{.ticks = 1000, .lost_ticks = 10}.contactLost()));
  EXPECT_TRUE((ForceError{.ticks = 1000, .lost_ticks = 11}.contactLost()));
  EXPECT_FALSE(ForceError{}.contactLost());
}

TEST(Spread, IsByRank) {
  std::vector<double> samples(1000);
  std::iota(samples.begin(), samples.end(), 1.0);
  std::shuffle(samples.begin(), samples.end(), std::mt19937(7));
  const Spread s = spreadOf(samples);
  EXPECT_EQ(s.count, 1000u);
  EXPECT_NEAR(s.median, 500.5, 0.5);
  EXPECT_EQ(s.p99, 990);
  EXPECT_EQ(s.p999, 999);
  EXPECT_EQ(spreadOf({}).count, 0u);
}

// Three rounds of four: what comes in one round is left out, and what comes in every round stays.
TEST(MediansOfRounds, LeaveOutWhatComesInOneRoundAlone) {
  const std::vector<double> samples{1, 2, 9, 4, 50, 2, 9, 5, 2, 2, 8, 70};
  EXPECT_EQ(mediansOfRounds(samples, 3), (std::vector<double>{2, 2, 9, 5}));
  EXPECT_EQ(mediansOfRounds(samples, 1), samples);
  EXPECT_TRUE(mediansOfRounds({}, 3).empty());
}

}  // namespace
}  // namespace relievo
