// SPDX-License-Identifier: Apache-2.0
// What is measured of a seek, and of the play time, with times alone.
#include "app/player/film/seek_times.h"

#include <gtest/gtest.h>

#include "app/player/film/played_time.h"

namespace relievo {
namespace {

constexpr MonotonicTime at(int ms) {
  return MonotonicTime(std::chrono::milliseconds(ms));
}

TEST(SeekTimes, CountFromTheKeyToThePictureAndToTheFirstTouchOnIt) {
  SeekTimes seeks;
  seeks.asked(mediaTime(10), true, at(1000));
  EXPECT_FALSE(seeks.waitsForTouch(at(1010))) << "the old surface still";
  seeks.shown(mediaTime(10.5), at(1030), at(1031));
  seeks.felt(at(1031), mediaTime(3));  // a tick from before
  seeks.felt(at(1032), mediaTime(10.5));
  seeks.felt(at(1033), mediaTime(10.75));
  ASSERT_EQ(seeks.entries().size(), 1U);
  const SeekEntry& seek = seeks.entries()[0];
  EXPECT_EQ(seek.target_s, 10);
  EXPECT_EQ(seek.picture_s, 10.5);
  EXPECT_EQ(seek.surface_s, 10.5);
  EXPECT_DOUBLE_EQ(seek.picture_ms.value_or(0), 30);
  EXPECT_DOUBLE_EQ(seek.surface_ms.value_or(0), 32);
}

TEST(SeekTimes, OfMonthsTheFirstAreKept) {
  SeekTimes seeks;
  for (int i = 0; i < 1000; ++i) seeks.asked(mediaTime(10), true, at(1000));
  seeks.asked(mediaTime(20), true, at(2000));
  seeks.shown(mediaTime(20), at(2030), at(2031));
  seeks.felt(at(2032), mediaTime(20));
  ASSERT_EQ(seeks.entries().size(), 1000U);
  EXPECT_EQ(seeks.entries().back().target_s, 10);
  EXPECT_EQ(seeks.entries().back().picture_s, std::nullopt) << "another seek's";
}

TEST(SeekTimes, OneThatTheViewerDidNotAskForIsNotCounted) {
  SeekTimes seeks;
  seeks.asked(mediaTime(10), true, at(1000));
  seeks.asked(mediaTime(10), false, at(1010));  // out of fast forward
  seeks.shown(mediaTime(10), at(1030), at(1030));
  seeks.felt(at(1031), mediaTime(10));
  ASSERT_EQ(seeks.entries().size(), 1U);
  EXPECT_EQ(seeks.entries()[0].picture_s, std::nullopt);
  EXPECT_EQ(seeks.entries()[0].surface_s, std::nullopt);
}

TEST(SeekTimes, TheNewestTargetGetsThePicture) {
  SeekTimes seeks;
  seeks.asked(mediaTime(10), true, at(1000));
  seeks.asked(mediaTime(20), true, at(1010));
  seeks.shown(mediaTime(20), at(1030), at(1030));
  ASSERT_EQ(seeks.entries().size(), 2U);
  EXPECT_EQ(seeks.entries()[0].picture_s, std::nullopt);
  EXPECT_EQ(seeks.entries()[1].picture_s, 20);
}

TEST(SeekTimes, AnotherFilmIsNotTakenForTheTarget) {
  SeekTimes seeks;
  seeks.asked(mediaTime(10), true, at(1000));
  seeks.forget();
  seeks.shown(mediaTime(0), at(1030), at(1030));
  EXPECT_EQ(seeks.entries()[0].picture_s, std::nullopt);
}

TEST(PlayedTime, LeavesThePausesOut) {
  PlayedTime played;
  played.end(mediaTime(5));  // it has not gone yet
  played.begin(mediaTime(1));
  played.end(mediaTime(3));
  played.end(mediaTime(4));
  played.begin(mediaTime(10));
  played.end(std::nullopt);  // without a clock nothing is known
  played.begin(mediaTime(20));
  played.end(mediaTime(21));
  EXPECT_EQ(played.total(), std::chrono::seconds(3));
}

}  // namespace
}  // namespace relievo
