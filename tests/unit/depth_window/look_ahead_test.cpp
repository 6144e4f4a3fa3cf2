// SPDX-License-Identifier: Apache-2.0
// What a live film waits for: the choice by period and delay, and the age that the arrivals ask for.
#include "app/depth_window/look_ahead.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/depth_window/touch_plan.h"
#include "app/haptics/method/frame_weights.h"

namespace relievo {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

// 50 ms are the age, 2 the margin: 38 are left for frames. At 60 frames/s two of them take 33, at 30 one takes 33; at
// 15 one takes 67, and 29 are missing.
TEST(LookAhead, IsWhatTheAgeLeavesRoomFor) {
  constexpr Duration kLate = milliseconds(10);
  EXPECT_EQ(lookAheadFor(microseconds(16'667), kLate), (LookAhead{2, Duration(0)}));
  EXPECT_EQ(lookAheadFor(microseconds(33'333), kLate), (LookAhead{1, Duration(0)}));
  EXPECT_EQ(lookAheadFor(microseconds(66'667), kLate), (LookAhead{1, microseconds(28'667)}));
  EXPECT_EQ(lookAheadFor(milliseconds(5), kLate), (LookAhead{3, Duration(0)})) << "no law needs more";
  EXPECT_EQ(lookAheadFor(Duration(0), kLate), LookAhead{}) << "a single picture";
  EXPECT_EQ(lookAheadFor(microseconds(33'333), milliseconds(30)), (LookAhead{1, microseconds(15'333)}));
}

// The surface of something that nods once a second may be carried forward so far that this time and the period are at
// most 1/pi s.
TEST(LookAhead, IsNotCarriedFurtherThanAnOldSurfaceIsOff) {
  EXPECT_EQ(lookAheadFor(milliseconds(33), milliseconds(300)).carried, milliseconds(33)) << "a period at most";
  EXPECT_NEAR(toSeconds(lookAheadFor(milliseconds(200), milliseconds(10)).carried), 0.3183 - 0.2, 1e-4);
  EXPECT_EQ(lookAheadFor(milliseconds(333), milliseconds(10)).carried, Duration(0)) << "3 frames/s";
}

TEST(LookAhead, OfThePlansLawsThoseRemainThatNeedNoMoreFrames) {
  for (const TimeLaw law :
       {TimeLaw::Hold, TimeLaw::Linear, TimeLaw::BSpline, TimeLaw::Fitted, TimeLaw::Adapted, TimeLaw::Mean}) {
    EXPECT_EQ(lawWithin(law, 3), law);
    for (const int frames : {1, 2, 3}) EXPECT_LE(framesAhead(lawWithin(law, frames)), frames) << name(law) << frames;
  }
  const ClipMeasure coarse{.frames = 4, .quantum_mm = 0.157, .sample_mm = 0.22, .period_s = 1.0 / 30};
  const FeltScale whole = planTouch(coarse).scale;
  const TouchPlan live = planTouch(coarse, {1, Duration(0)}), carried = planTouch(coarse, {1, milliseconds(30)});
  EXPECT_EQ(whole.wide_time, TimeLaw::Adapted);
  EXPECT_EQ(live.scale.wide_time, TimeLaw::Linear);
  EXPECT_EQ(live.reason.find("carried"), std::string::npos);
  EXPECT_NE(carried.reason.find(", carried forward by 30 ms"), std::string::npos) << carried.reason;
}

// The mean of squares of Linear's weights is 2/3; carried forward by a period, (2s)^2 + (2 - 3s)^2 + (1 - s)^2 has 8/3.
// So noise weighs twice as much, and where noise is all there is, its width grows.
TEST(LookAhead, WhatIsCarriedForwardIsSmoothedMore) {
  const ClipMeasure noisy{.frames = 4, .quantum_mm = 0.001, .noise_mm = 0.4, .sample_mm = 0.22, .period_s = 1.0 / 30};
  const TouchPlan waits = planTouch(noisy, {1, Duration(0)}), carried = planTouch(noisy, {1, microseconds(33'333)});
  EXPECT_GT(carried.scale.wide_mm, waits.scale.wide_mm);
  EXPECT_NEAR(carried.scale.clamp_mm, 2 * waits.scale.clamp_mm, 0.01);
}

Arrivals steady(int frames, Duration period, Duration delay) {
  Arrivals arrivals;
  for (int k = 0; k < frames; ++k) arrivals.add(MediaTime(k * period), delay);
  return arrivals;
}

TEST(Arrivals, AgeIsTheFramesAheadAndTheDelay) {
  const Arrivals even = steady(200, milliseconds(40), milliseconds(7));
  EXPECT_EQ(even.period(), milliseconds(40));
  EXPECT_EQ(even.late(), milliseconds(7));
  for (const int frames : {0, 1, 2, 3, 5}) {
    EXPECT_EQ(even.age({frames, Duration(0)}), frames * milliseconds(40) + milliseconds(7) + Arrivals::kMargin);
  }
  EXPECT_EQ(even.age({1, milliseconds(15)}), milliseconds(40 + 7 - 15) + Arrivals::kMargin);
  EXPECT_EQ(Arrivals{}.age({1, Duration(0)}), Arrivals::kMargin) << "nothing is known";
}

// Two late frames in a hundred do not raise the age, a third one does. Some time later the age is as before.
TEST(Arrivals, ALoneLateFrameDoesNotCount) {
  Arrivals arrivals;
  int k = 0;
  const auto add = [&](int count, Duration delay) {
    for (int i = 0; i < count; ++i) arrivals.add(MediaTime(k++ * milliseconds(40)), delay);
  };
  add(128, milliseconds(5));
  add(2, milliseconds(25));
  EXPECT_EQ(arrivals.late(), milliseconds(5));
  add(1, milliseconds(25));
  EXPECT_EQ(arrivals.late(), milliseconds(25));
  EXPECT_EQ(arrivals.age({1, Duration(0)}), milliseconds(65) + Arrivals::kMargin);
  add(128, milliseconds(5));
  EXPECT_EQ(arrivals.late(), milliseconds(5));
}

// Times that are uneven in themselves: from one frame to the next there are 30 ms or 50.
TEST(Arrivals, UnevenTimesOfTheCameraCount) {
  Arrivals arrivals;
  for (int k = 0; k < 100; ++k) arrivals.add(MediaTime(k * milliseconds(40) + (k % 2) * milliseconds(10)), {});
  EXPECT_EQ(arrivals.age({1, Duration(0)}), milliseconds(50) + Arrivals::kMargin);
  EXPECT_EQ(arrivals.age({2, Duration(0)}), milliseconds(80) + Arrivals::kMargin);
}

// What a camera has piled up while it was opened comes at once: each frame is 40 ms less late than the one before.
TEST(Arrivals, WhatWasPiledUpComesFasterThanItWasTaken) {
  Arrivals arrivals;
  for (int k = 0; k < 5; ++k) {
    arrivals.add(MediaTime(k * milliseconds(40)), milliseconds(200) - k * milliseconds(39));
    EXPECT_FALSE(arrivals.keepsPace()) << k;
  }
  arrivals.add(MediaTime(5 * milliseconds(40)), milliseconds(6));
  EXPECT_FALSE(arrivals.keepsPace());
  arrivals.add(MediaTime(6 * milliseconds(40)), milliseconds(9));
  EXPECT_TRUE(arrivals.keepsPace());
  arrivals.add(MediaTime{}, milliseconds(9));
  EXPECT_EQ(arrivals.count(), 1u) << "another stream";
}

TEST(Arrivals, AClockGainsInHalfASecondAndByFivePercentAtMost) {
  EXPECT_DOUBLE_EQ(rateToGain(milliseconds(5)), 1.01);
  EXPECT_DOUBLE_EQ(rateToGain(milliseconds(-10)), 0.98);
  EXPECT_DOUBLE_EQ(rateToGain(std::chrono::seconds(1)), 1.05);
  EXPECT_DOUBLE_EQ(rateToGain(std::chrono::seconds(-1)), 0.95);
}

}  // namespace
}  // namespace relievo
