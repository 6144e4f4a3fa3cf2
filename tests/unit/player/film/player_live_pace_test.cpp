// SPDX-License-Identifier: Apache-2.0
// The pace of a live film, and the ages it reports, in simulated time.
#include "app/player/film/live_pace.h"

#include <gtest/gtest.h>

#include "app/player/film/live_times.h"

namespace relievo {
namespace {

using std::chrono::milliseconds;

constexpr Duration kPeriod = milliseconds(40);
constexpr MonotonicTime kOrigin{std::chrono::seconds(100)};

struct Camera {
  LivePace pace;
  int next = 0;

  void send(int pairs, Duration delay) {
    for (int i = 0; i < pairs; ++i) {
      FramePair pair;
      pair.color.pts = MediaTime(next++ * kPeriod);
      pair.taken = kOrigin + pair.color.pts.time_since_epoch();
      pair.delay = delay;
      pace.hear(pair);
      pace.hear(pair);  // the player sees it again and again
    }
  }
};

// 25 frames/s: one period, and at first the 10 ms that are assumed; then the 6 that the camera takes.
TEST(LivePace, TheSurfaceIsAsOldAsAFrameAndItsDelay) {
  Camera camera;
  camera.send(3, milliseconds(6));
  EXPECT_FALSE(camera.pace.settled()) << "four make a rate";
  camera.send(3, milliseconds(6));
  ASSERT_TRUE(camera.pace.settled());
  ASSERT_TRUE(camera.pace.choose());
  EXPECT_EQ(camera.pace.lookAhead(), (LookAhead{1, milliseconds(40 + 10 + 2 - 50)}));
  EXPECT_EQ(camera.pace.age(), milliseconds(50));
  camera.send(60, milliseconds(6));
  EXPECT_EQ(camera.pace.age(), milliseconds(40 + 6 + 2 - 2));
  EXPECT_EQ(camera.pace.wanted(kOrigin + milliseconds(1046)), MediaTime(milliseconds(1000)));
  EXPECT_EQ(camera.pace.next(), kOrigin + 66 * kPeriod + milliseconds(6));
  camera.send(60, milliseconds(20));
  EXPECT_EQ(camera.pace.age(), milliseconds(40 + 20 + 2 - 2)) << "a stream that has become slower";
}

// What was piled up while a camera was opened comes at once; nothing of it is waited for later.
TEST(LivePace, ABacklogIsPassedByAndForgotten) {
  Camera camera;
  for (int late = 400; late > 40; late -= 40) {
    camera.send(1, milliseconds(late));
    EXPECT_FALSE(camera.pace.settled()) << late;
  }
  camera.send(1, milliseconds(10));
  camera.send(1, milliseconds(10));
  EXPECT_TRUE(camera.pace.settled());
  EXPECT_TRUE(camera.pace.choose());
  camera.send(40, milliseconds(4));
  EXPECT_EQ(camera.pace.age() + camera.pace.lookAhead().carried, milliseconds(40 + 10 + 2));
}

TEST(LivePace, ASourceThatSendsAheadOfItsTimeIsNoCamera) {
  Camera camera;
  camera.send(4, milliseconds(5));
  camera.send(3, milliseconds(-30));
  EXPECT_TRUE(camera.pace.settled());
  EXPECT_FALSE(camera.pace.choose());
  camera.send(100, milliseconds(5));
  EXPECT_FALSE(camera.pace.choose()) << "once and for all";
}

// Pictures are 90 ms old when they are seen. Touch that is 46 ms old would be 44 ms ahead of them, but at most 15 are
// allowed. A single late picture changes nothing.
TEST(LivePace, TouchIsNotFurtherAheadOfThePicturesThanPeopleNotice) {
  Camera camera;
  camera.send(60, milliseconds(6));
  ASSERT_TRUE(camera.pace.choose());
  camera.send(60, milliseconds(6));
  const Duration quick = camera.pace.age();
  for (int i = 0; i < 40; ++i) camera.pace.shown(milliseconds(30));
  camera.pace.shown(milliseconds(500));
  EXPECT_EQ(camera.pace.age(), quick);
  for (int i = 0; i < 40; ++i) camera.pace.shown(milliseconds(90));
  EXPECT_EQ(camera.pace.age(), milliseconds(75));
}

TEST(LiveTimes, TellAgesAndHowFarTouchAndPictureAreApart) {
  LiveTimes times;
  EXPECT_FALSE(times.summary());
  times.felt(kOrigin, MediaTime{});
  times.begin(kOrigin, kOrigin + milliseconds(100));
  for (int i = 0; i < 10; ++i) times.shown(milliseconds(20), milliseconds(50));
  EXPECT_FALSE(times.summary()->touch) << "the tick came before the film began";
  times.shown(milliseconds(60), milliseconds(50));
  for (int i = 0; i < 100; ++i) times.felt(kOrigin + milliseconds(200 + i), MediaTime(milliseconds(150 + i)));
  const LiveLatency told = times.summary().value();
  EXPECT_NEAR(told.picture.p50_ms, 20, 1.2) << "within the histogram's 6 %";
  EXPECT_DOUBLE_EQ(told.picture.max_ms, 60);
  EXPECT_DOUBLE_EQ(told.touch->max_ms, 50);
  EXPECT_DOUBLE_EQ(told.before.max_ms, 10);
  EXPECT_DOUBLE_EQ(told.before.p50_ms, 0);
  EXPECT_DOUBLE_EQ(told.behind.max_ms, 30);
}

}  // namespace
}  // namespace relievo
