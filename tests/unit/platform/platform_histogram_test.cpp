// SPDX-License-Identifier: Apache-2.0
// The histogram compared with the sorted values, and at the ends of its range.
#include "platform/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace relievo {
namespace {

using std::chrono::hours;
using std::chrono::nanoseconds;
using std::chrono::seconds;

double relativeError(Duration got, Duration truth) {
  return std::abs(static_cast<double>((got - truth).count())) / static_cast<double>(truth.count());
}

TEST(Histogram, HasNoQuantileWhileEmpty) {
  const Histogram histogram;
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.quantile(0.5), Duration(0));
  EXPECT_EQ(histogram.max(), Duration(0));
}

TEST(Histogram, TellsHowManyOfEachLength) {
  Histogram histogram;
  for (const int ns : {3, 1000, 3}) histogram.add(nanoseconds(ns));
  std::vector<std::pair<Duration, std::uint64_t>> told;
  histogram.forEachBucket([&](Duration time, std::uint64_t count) { told.emplace_back(time, count); });
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0], std::pair(Duration(3), std::uint64_t{2}));
  EXPECT_EQ(told[1].second, 1U);
  EXPECT_LT(relativeError(told[1].first, nanoseconds(1000)), 0.06);
}

TEST(Histogram, GivesQuantilesWithinSixPercentOfTheSortedValues) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(0.0,
                                                  10.0);  // 1 ns to 10 s, each decade as often as the next
  std::vector<Duration> values;
  Histogram histogram;
  for (int i = 0; i < 20'000; ++i) {
    values.emplace_back(static_cast<Duration::rep>(std::pow(10.0, exponent(random))));
    histogram.add(values.back());
  }
  std::sort(values.begin(), values.end());
  ASSERT_EQ(histogram.count(), values.size());
  EXPECT_EQ(histogram.max(), values.back());
  for (const double fraction : {0.0, 0.001, 0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1));
    EXPECT_LT(relativeError(histogram.quantile(fraction), values[rank]), 0.06) << "quantile " << fraction;
  }
}

// The second, far larger, value keeps max() from hiding the bucket's own figure.
Duration bucketOfOne(Duration value) {
  Histogram histogram;
  histogram.add(value);
  histogram.add(hours(1));
  return histogram.quantile(0.0);
}

TEST(Histogram, KeepsItsPromiseForEachSmallValueAndAtEachBucketsEdges) {
  for (Duration::rep ns = 1; ns < 4096; ++ns) {
    ASSERT_LT(relativeError(bucketOfOne(Duration(ns)), Duration(ns)), 0.06) << ns << " ns";
  }
  // The last bucket ends at 2^34 ns, 17 s; a bucket is an eighth of an octave.
  for (int octave = 12; octave < 34; ++octave) {
    for (int eighth = 8; eighth < 16; ++eighth) {
      const Duration low(static_cast<Duration::rep>(eighth) << (octave - 3));
      const Duration high(static_cast<Duration::rep>(eighth + 1) << (octave - 3));
      ASSERT_LT(relativeError(bucketOfOne(low), low), 0.06) << low.count() << " ns";
      ASSERT_LT(relativeError(bucketOfOne(high - nanoseconds(1)), high), 0.06) << high.count() << " ns";
    }
  }
}

TEST(Histogram, TellsValuesBelowSixteenNanosecondsExactly) {
  for (Duration::rep ns = 0; ns < 16; ++ns) EXPECT_EQ(bucketOfOne(Duration(ns)), Duration(ns));
}

TEST(Histogram, CountsANegativeDurationAsZero) {
  Histogram histogram;
  histogram.add(Duration(-5));
  EXPECT_EQ(histogram.count(), 1u);
  EXPECT_EQ(histogram.quantile(1.0), Duration(0));
  EXPECT_EQ(histogram.max(), Duration(0));
}

TEST(Histogram, NeverPutsAQuantileAboveTheMaximum) {
  Histogram histogram;
  histogram.add(Duration(1024));  // the lower edge of its bucket: the middle lies above it
  EXPECT_EQ(histogram.quantile(0.5), Duration(1024));
}

TEST(Histogram, HoldsAnHourInItsLastBucketAndAsTheExactMaximum) {
  Histogram histogram;
  histogram.add(hours(1));
  EXPECT_EQ(histogram.max(), hours(1));
  EXPECT_GE(histogram.quantile(0.5), seconds(16));
  EXPECT_EQ(histogram.count(), 1u);
}

}  // namespace
}  // namespace relievo
