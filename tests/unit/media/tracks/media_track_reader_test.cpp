// SPDX-License-Identifier: Apache-2.0
// Two tracks of one source: bounded queues, badly interleaved and short tracks, seeks that land too late; its end.
#include <gtest/gtest.h>

#include <future>
#include <vector>

#include "app/media/pairs/open_sources.h"
#include "app/media/tracks/track_reader.h"
#include "tests/unit/media/tracks/film_of_tracks.h"

namespace relievo::test {
namespace {

TEST(TrackReader, GivesEachTrackInOrderWhicheverIsAsked) {
  Film film(interleaved(10, 1));
  for (int k = 0; k < 5; ++k) EXPECT_EQ(film.next(0), 40 * k);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(film.next(1), 40 * k);
  EXPECT_EQ(film.next(1), -1);
  EXPECT_TRUE(film.reader->ended(1));
  EXPECT_FALSE(film.reader->ended(0));
  for (int k = 5; k < 10; ++k) EXPECT_EQ(film.next(0), 40 * k);
  EXPECT_EQ(film.next(0), -1);
}

TEST(TrackReader, TakesNoFourthTrack) {
  Film film(interleaved(1, 1));
  ASSERT_TRUE(film.reader->select(film.source->streams()[0]).has_value());
  const auto fourth = film.reader->select(film.source->streams()[0]);
  ASSERT_FALSE(fourth.has_value());
  EXPECT_EQ(fourth.error().code, ErrorCode::Exhausted);
}

// After the depth's end the reader must not search the rest of the film for more of it.
TEST(TrackReader, ATrackWithNothingToGiveIsGivenUpForNow) {
  std::vector<Scripted> script{{1, 0, true}};
  for (int k = 0; k < 2000; ++k) script.push_back({0, 40 * k, true});
  Film film(script);
  EXPECT_EQ(film.next(1), 0);
  EXPECT_EQ(film.next(1), -1);
  EXPECT_FALSE(film.reader->ended(1));
  EXPECT_EQ(film.source->position, 1 + TrackReader::kMaxWaitingPackets);
  for (int k = 0; k < 2000; ++k) ASSERT_EQ(film.next(0), 40 * k);
}

TEST(TrackReader, LargePacketsAreBoundedByTheirBytes) {
  std::vector<Scripted> script{{1, 0, true}};
  for (int k = 0; k < 200; ++k) script.push_back({0, 40 * k, true});
  Film film(script);
  film.source->packet_bytes = TrackReader::kMaxWaitingBytes / 10;
  EXPECT_EQ(film.next(1), 0);
  EXPECT_EQ(film.next(1), -1);
  EXPECT_EQ(film.source->position, 1 + 11u);  // the eleventh exceeds the bound
}

TEST(TrackReader, WhatWasTakenCountsNoLonger) {
  Film film(interleaved(60, 1));
  film.source->packet_bytes = TrackReader::kMaxWaitingBytes / 10;
  for (int k = 0; k < 60; ++k) {
    ASSERT_EQ(film.next(0), 40 * k);
    ASSERT_EQ(film.next(1), 40 * k);
  }
}

// All depth packets come before the colour's: the colour continues, the depth resumes at a key frame.
TEST(TrackReader, TheLeadingTrackIsNeverHeldUpByTheOther) {
  std::vector<Scripted> script;
  const int count = static_cast<int>(TrackReader::kMaxWaitingPackets) + 100;
  for (int k = 0; k < count; ++k) script.push_back({1, 40 * k, k % 50 == 0});
  for (int k = 0; k < 3; ++k) script.push_back({0, 40 * k, true});
  Film film(script);
  EXPECT_EQ(film.next(0), 0);
  EXPECT_EQ(film.next(1), 40 * 800);  // 768 were dropped, 769 to 799 cannot be decoded
  EXPECT_EQ(film.next(1), 40 * 801);
}

TEST(TrackReader, HoldingMorePicturesThanTheDecoderAllowsIsAnErrorAndNoHang) {
  Film film(interleaved(10, 1), 0, 3);
  std::vector<Frame> held;
  for (int i = 0; i < 3; ++i) held.push_back(film.reader->next(0).value().value());
  const auto refused = film.reader->next(0);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::Exhausted);
  held.pop_back();
  EXPECT_EQ(film.next(0), 120);
}

TEST(TrackReader, ASeekBringsEveryTrackToTheTargetOrBefore) {
  Film film(interleaved(100, 12));
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 30))).has_value());
  EXPECT_EQ(film.next(0), 40 * 24);
  EXPECT_EQ(film.next(1), 40 * 24);
  EXPECT_EQ(film.next(0), 40 * 25);
  EXPECT_EQ(film.source->seeks, 1);
}

// The depth's key frames are at other times: from the colour's key frame on, depth cannot be decoded until after the
// target.
TEST(TrackReader, ASeekGoesFartherBackForTheOtherTracksKeyFrame) {
  std::vector<Scripted> script;
  for (int k = 0; k < 200; ++k) {
    script.push_back({0, 40 * k, k % 10 == 0});
    script.push_back({1, 40 * k, k % 40 == 35});
  }
  Film film(script);
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 112))).has_value());
  EXPECT_LE(film.next(0), 40 * 112);
  EXPECT_EQ(film.next(1), 40 * 75);
  EXPECT_EQ(film.source->seeks, 3);  // from 110 and from 80 (1 s back) depth begins at 115, from 60 (2 s) at 75
}

TEST(TrackReader, ASeekThatLandsTooLateIsTriedFromEarlier) {
  Film film(interleaved(100, 12), 20);  // 10 pictures too late
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 26))).has_value());
  EXPECT_LE(film.next(0), 40 * 26);
  EXPECT_LE(film.next(1), 40 * 26);
  EXPECT_GT(film.source->seeks, 1);
}

TEST(TrackReader, ASeekBeyondTheOtherTracksEndDoesNotSearchTheWholeFilmForIt) {
  std::vector<Scripted> script = interleaved(10, 10);
  for (int k = 10; k < 1000; ++k) script.push_back({0, 40 * k, k % 10 == 0});
  Film film(script);
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 505))).has_value());
  EXPECT_EQ(film.source->seeks, 2);
  EXPECT_LE(film.next(0), 40 * 505);
  EXPECT_EQ(film.next(1), -1);
}

TEST(TrackReader, SeeksBackAfterTheEnd) {
  Film film(interleaved(24, 12));
  while (film.next(0) >= 0) {
  }
  while (film.next(1) >= 0) {
  }
  EXPECT_TRUE(film.reader->ended(0));
  ASSERT_TRUE(film.reader->seek(MediaTime{}).has_value());
  EXPECT_FALSE(film.reader->ended(0));
  EXPECT_EQ(film.next(0), 0);
  EXPECT_EQ(film.next(1), 0);
}

// Key frames lie 200 ms apart. Each is decoded by itself, so that its decoder comes to an end with each.
TEST(TrackReader, KeyStepsGiveKeyFramesSoFarApartAlsoAfterTheEndAndBackwards) {
  const auto expectSteps = [](Film& film, int from) {
    ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(from)), milliseconds(300)).has_value());
    for (int k = 0; k < 3; ++k) {
      for (const std::size_t track : {0U, 1U}) EXPECT_EQ(film.next(track), from + 400 * k) << track;
    }
  };
  Film film(interleaved(60, 5));
  while (film.next(0) >= 0) {
  }
  expectSteps(film, 0);
  expectSteps(film, 1200);
  expectSteps(film, 400);
  ASSERT_TRUE(film.reader->seek(MediaTime{}).has_value());
  for (int k = 0; k < 3; ++k) EXPECT_EQ(film.next(0), 40 * k) << "all pictures again";
}

TEST(TrackReader, WhatWasWaitingBeforeASeekTakesNoRoomAfterIt) {
  Film film(interleaved(20, 1));
  film.source->packet_bytes = TrackReader::kMaxWaitingBytes / 4;
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(film.reader->seek(MediaTime{}).has_value());
    for (int k = 0; k < 5; ++k) EXPECT_EQ(film.next(0), 40 * k);
  }
  EXPECT_EQ(film.next(1), 0);
  EXPECT_EQ(film.next(1), 40);
}

// Closing joins a decoder's threads and may ask a server; the player's loop interrupts and asks meanwhile.
TEST(OpenSources, AnswerWhileOneIsClosed) {
  OpenSources sources;
  auto source = std::make_unique<ScriptedSource>(interleaved(1, 1));
  std::future<bool> asked;
  std::future_status answered = std::future_status::deferred;
  source->closing = [&] {
    asked = std::async(std::launch::async, [&] {
      sources.interrupt();
      return sources.waitsForColor(nullptr);
    });
    answered = asked.wait_for(std::chrono::minutes(1));
  };
  ASSERT_TRUE(sources.take(std::make_unique<TrackReader>(std::move(source), nullptr)).has_value());
  sources.close();
  EXPECT_EQ(answered, std::future_status::ready);
  EXPECT_FALSE(asked.get());
}

}  // namespace
}  // namespace relievo::test
