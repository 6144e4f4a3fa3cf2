// SPDX-License-Identifier: Apache-2.0
// The weight of each frame: between frames, at a cut, before the first one and after the last.
#include "app/haptics/method/frame_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace relievo {
namespace {

constexpr double kPeriod = 1.0 / 30;

SurfaceWindow emptyFrames(int count) {
  SurfaceWindow w;
  w.count = count;
  for (int k = 0; k < count; ++k) w.frames[static_cast<std::size_t>(k)].time = mediaTime(k * kPeriod);
  return w;
}

FrameWeights weightsOf(const FrameMoment& moment, TimeLaw law) {
  return frameWeights(moment, FrameTaps(moment, law));
}

double at(const SurfaceWindow& w, TimeLaw law, double t, const std::vector<double>& values) {
  const FrameWeights weights = weightsOf(FrameMoment(w, mediaTime(t)), law);
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0);
}

TEST(FrameWeights, EveryLawGivesALineBackAndTheFittedOneACubic) {
  const SurfaceWindow w = emptyFrames(8);
  std::vector<double> line, cubic;
  const auto c = [](double k) { return 0.3 * k * k * k - 2 * k * k + k; };
  for (int k = 0; k < 8; ++k) {
    line.push_back(3 - 0.5 * k);
    cubic.push_back(c(k));
  }
  for (double k = 2; k < 4.99; k += 0.13) {
    for (const TimeLaw law : {TimeLaw::Linear, TimeLaw::BSpline, TimeLaw::Fitted}) {
      ASSERT_NEAR(at(w, law, k * kPeriod, line), 3 - 0.5 * k, 1e-5) << name(law) << ' ' << k;
    }
    ASSERT_NEAR(at(w, TimeLaw::Fitted, k * kPeriod, cubic), c(k), 1e-4) << k;
    const FrameMoment moment(w, mediaTime(k * kPeriod));
    const FrameWeights added = frameWeights(moment, FrameTaps::addedByFitted(moment));
    const double adds = std::inner_product(cubic.begin(), cubic.end(), added.begin(), 0.0);
    ASSERT_NEAR(at(w, TimeLaw::Adapted, k * kPeriod, cubic) + adds, c(k), 1e-4) << k;
    ASSERT_EQ(at(w, TimeLaw::Hold, k * kPeriod, line), 3 - 0.5 * std::floor(k + 1e-9)) << k;
  }
  EXPECT_GT(std::abs(at(w, TimeLaw::BSpline, 3.0 * kPeriod, cubic) - c(3)), 0.1) << "a B-spline smooths";
}

// The mean over a box of five periods around the moment: what alternates from frame to frame is left with a fifth, and
// a parabola k^2 is off by the box's variance of 25/12.
TEST(FrameWeights, TheMeanAveragesFivePeriods) {
  const SurfaceWindow w = emptyFrames(8);
  std::vector<double> line, parabola, alternating;
  for (int k = 0; k < 8; ++k) {
    line.push_back(3 - 0.5 * k);
    parabola.push_back(k * k);
    alternating.push_back(k % 2 == 0 ? 1 : -1);
  }
  for (double k = 2; k < 4.99; k += 0.13) {
    ASSERT_NEAR(at(w, TimeLaw::Mean, k * kPeriod, line), 3 - 0.5 * k, 1e-5) << k;
    ASSERT_LE(std::abs(at(w, TimeLaw::Mean, k * kPeriod, alternating)), 0.2 + 1e-5) << k;
  }
  EXPECT_NEAR(at(w, TimeLaw::Mean, 3 * kPeriod, parabola), 9 + (4 + 1 + 0 + 1 + 4) / 5.0, 1e-4);
}

TEST(FrameWeights, AShotsFirstAndLastFramesHoldAndNothingComesFromBeyondACut) {
  SurfaceWindow w = emptyFrames(8);
  for (std::size_t k = 4; k < 8; ++k) w.frames[k].shot = 1;
  const std::vector<double> values{1, 1, 1, 1, 9, 9, 9, 9};
  for (double k = 0; k < 7.9; k += 0.09) {
    for (const TimeLaw law :
         {TimeLaw::Hold, TimeLaw::Linear, TimeLaw::BSpline, TimeLaw::Fitted, TimeLaw::Adapted, TimeLaw::Mean}) {
      ASSERT_NEAR(at(w, law, k * kPeriod, values), k + 1e-6 < 4 ? 1 : 9, 1e-5) << name(law) << ' ' << k;
    }
  }
}

TEST(FrameWeights, TheLastFrameIsReachedWithinAPeriodAndThenHolds) {
  const SurfaceWindow w = emptyFrames(3);
  const std::vector<double> values{1, 2, 5};
  for (const double k : {3.0, 3.5, 50.0}) {
    EXPECT_NEAR(at(w, TimeLaw::Linear, k * kPeriod, values), 5, 1e-5) << k;
    EXPECT_NEAR(at(w, TimeLaw::BSpline, k * kPeriod, values), 5, 1e-5) << k;
    EXPECT_NEAR(at(w, TimeLaw::Fitted, k * kPeriod, values), 5 + 3.0 / 36, 1e-5) << "its overshoot stays";
  }
  // The spline continues on its way there: half a period later 1/48 of the frame before is left.
  EXPECT_NEAR(at(w, TimeLaw::BSpline, 2 * kPeriod, values), 5 - 3.0 / 6, 1e-5);
  EXPECT_NEAR(at(w, TimeLaw::BSpline, 2.5 * kPeriod, values), 5 - 3.0 / 48, 1e-5);
}

TEST(FrameWeights, BeforeTheFirstFrameAndOnAPictureItIsTheFirst) {
  const SurfaceWindow film = emptyFrames(3), picture = emptyFrames(1);
  for (const TimeLaw law :
       {TimeLaw::Hold, TimeLaw::Linear, TimeLaw::BSpline, TimeLaw::Fitted, TimeLaw::Adapted, TimeLaw::Mean}) {
    EXPECT_NEAR(at(film, law, -1, {1, 1, 9}), at(film, law, 0, {1, 1, 9}), 1e-6) << name(law);
    EXPECT_NEAR(at(picture, law, 7, {3}), 3, 1e-5) << name(law);
  }
  EXPECT_EQ(weightsOf(FrameMoment(SurfaceWindow{}, {}), TimeLaw::Fitted), FrameWeights{}) << "no frame at all";
}

}  // namespace
}  // namespace relievo
