// SPDX-License-Identifier: Apache-2.0
// The feed with its reader's side called by hand, in simulated time; and with its thread, stalled and interrupted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "app/media/film_feed.h"
#include "app/media/playhead.h"
#include "drivers/mock/mock.h"
#include "platform/clock.h"
#include "tests/unit/media/feed/film_feed_stage.h"

namespace relievo::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using State = FilmFeed::State;

TEST_F(FilmFeedTest, OpensThenReadsInOrderAndNoFurtherThanItsCapacity) {
  FilmFeed& feed = open(filmOf(10));
  EXPECT_EQ(feed.state(), State::Opening);
  EXPECT_TRUE(feed.work());
  EXPECT_EQ(feed.state(), State::Reading);
  EXPECT_EQ(feed.info().color_width, 16);
  EXPECT_TRUE(feed.info().has_depth);
  EXPECT_EQ(workAll(), 4);
  EXPECT_THAT(takeAll(), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(workAll(), 4);
  EXPECT_THAT(takeAll(), ElementsAre(4, 5, 6, 7));
}

TEST_F(FilmFeedTest, EndsWithWhatWasReadStillToBeTaken) {
  FilmFeed& feed = open(filmOf(3));
  workAll();
  EXPECT_EQ(feed.state(), State::Ended);
  EXPECT_THAT(takeAll(), ElementsAre(0, 1, 2));
  EXPECT_THAT(takeAll(), IsEmpty());
  EXPECT_EQ(feed.counters().pairs, 3u);
}

TEST_F(FilmFeedTest, ASeekForgetsWhatWasReadAndGoesOnAtTheTarget) {
  FilmFeed& feed = open(filmOf(100));
  workAll();
  feed.seek(MediaTime(50 * kPeriod));
  EXPECT_EQ(feed.state(), State::Seeking);
  EXPECT_THAT(takeAll(), IsEmpty());
  workAll();
  EXPECT_EQ(feed.state(), State::Reading);
  EXPECT_THAT(takeAll(), ElementsAre(50, 51, 52, 53));
}

TEST_F(FilmFeedTest, TheNewestOfTwoSeeksHolds) {
  FilmFeed& feed = open(filmOf(100));
  workAll();
  feed.seek(MediaTime(50 * kPeriod));
  feed.seek(MediaTime(20 * kPeriod));
  workAll();
  EXPECT_THAT(takeAll(), ElementsAre(20, 21, 22, 23));
}

// The viewer seeks while the reader decodes a picture: simulated from inside the decoder.
TEST_F(FilmFeedTest, APictureThatWasUnderWayWhenTheViewerSoughtIsDropped) {
  MockMediaProfile profile = filmOf(100);
  profile.tracks[0].sample = [this](int frame, int, int, int) {
    if (frame == 3 && feed_->state() == State::Reading) feed_->seek(MediaTime(50 * kPeriod));
    return std::uint16_t{0};
  };
  open(profile);
  workAll();
  EXPECT_THAT(takeAll(), ElementsAre(50, 51, 52, 53));
}

TEST_F(FilmFeedTest, ASeekThatWasUnderWayWhenANewerCameIsNotTheEndOfSeeking) {
  MockMediaProfile profile = filmOf(100);
  bool sought_again = false;
  profile.tracks[0].sample = [&](int frame, int, int, int) {
    if (frame == 50 && !std::exchange(sought_again, true)) feed_->seek(MediaTime(20 * kPeriod));
    return std::uint16_t{0};
  };
  FilmFeed& feed = open(profile);
  workAll();
  feed.seek(MediaTime(50 * kPeriod));
  EXPECT_TRUE(feed.work());
  EXPECT_TRUE(sought_again);
  EXPECT_EQ(feed.state(), State::Seeking);
  workAll();
  EXPECT_THAT(takeAll(), ElementsAre(20, 21, 22, 23));
}

TEST_F(FilmFeedTest, SeeksBackFromTheEnd) {
  FilmFeed& feed = open(filmOf(3));
  workAll();
  feed.seek(MediaTime(1 * kPeriod));
  workAll();
  EXPECT_THAT(takeAll(), ElementsAre(1, 2));
}

TEST_F(FilmFeedTest, IgnoresASeekBeforeTheFilmIsOpen) {
  FilmFeed& feed = open(filmOf(10));
  feed.seek(MediaTime(5 * kPeriod));
  EXPECT_EQ(feed.state(), State::Opening);
}

TEST_F(FilmFeedTest, ASourceThatCannotSeekGoesOnAndSaysSoOnce) {
  MockMediaProfile profile = filmOf(100);
  profile.live = true;
  FilmFeed& feed = open(profile);
  workAll();
  feed.seek(MediaTime(50 * kPeriod));
  workAll();
  const auto refused = feed.takeSeekError();
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->code, ErrorCode::Unsupported);
  EXPECT_FALSE(feed.takeSeekError());
  EXPECT_EQ(feed.state(), State::Reading);
  EXPECT_EQ(takeAll().size(), kCapacity);
}

TEST_F(FilmFeedTest, NamesTheSourceThatDoesNotOpen) {
  MockMediaProfile profile = filmOf(10);
  profile.fail_open = ErrorCode::NotFound;
  FilmFeed& feed = open(profile);
  workAll();
  EXPECT_EQ(feed.state(), State::Failed);
  EXPECT_EQ(feed.failure().error.code, ErrorCode::NotFound);
  EXPECT_EQ(feed.failure().thing, "mock");
}

TEST_F(FilmFeedTest, ASourceThatIsLostFailsAfterWhatWasRead) {
  MockMediaProfile profile = filmOf(100);
  profile.lose_after_packets = 12;
  FilmFeed& feed = open(profile);
  int taken = 0;
  while (workAll() > 0) {
    while (feed.take()) ++taken;
  }
  EXPECT_EQ(feed.state(), State::Failed);
  EXPECT_EQ(feed.failure().error.code, ErrorCode::Lost);
  EXPECT_GE(taken, 1);
  EXPECT_LE(taken, 7);  // two packets make a pair; the last may lack its depth
}

// Retried after 0.25 s, then at growing intervals of at most 4 s.
TEST_F(FilmFeedTest, ALostSourceIsTriedEverMoreSeldomAndNotForEver) {
  std::vector<double> tries;
  PairReader::Backends parts = backends({}, clock_);
  parts.make_source = [&, made = 0](const std::string&) mutable {
    MockMediaProfile profile = filmOf(100);
    profile.remote = profile.live = true;
    profile.lose_after_packets = 6;
    if (made++ > 0) {
      tries.push_back(toSeconds(clock_.now() - MonotonicTime{}));
      profile.fail_open = ErrorCode::Io;
    }
    return makeMockSource(profile, clock_);
  };
  FilmFeed feed(parts, kCapacity);
  feed.open({.url = "mock"});
  while (feed.state() != State::Failed) {
    while (feed.work()) {
      while (feed.take()) {
      }
    }
    clock_.advance(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(feed.failure().error.code, ErrorCode::Lost);
  ASSERT_EQ(tries.size(), 31u);
  EXPECT_NEAR(tries[0], 0.25, 0.02);
  for (std::size_t i = 1; i < tries.size(); ++i) {
    EXPECT_NEAR(tries[i] - tries[i - 1], std::max(0.25, tries[i - 1] / 8), 0.02) << i;
  }
  EXPECT_GT(tries.back(), 30.0);
  const auto news = feed.takeNews();
  ASSERT_TRUE(news);
  EXPECT_EQ(news->kind, FilmFeed::News::Kind::ColorLost);
  EXPECT_FALSE(feed.takeNews());
}

TEST_F(FilmFeedTest, IsClosedAfterAStopAndDoesNoMoreWork) {
  FilmFeed& feed = open(filmOf(10));
  workAll();
  feed.stop();
  feed.stop();
  EXPECT_FALSE(feed.work());
  EXPECT_EQ(feed.state(), State::Closed);
  EXPECT_THAT(takeAll(), IsEmpty());
}

// The reader blocks in a source that stalls for an hour; only an interrupt ends that.
TEST(FilmFeedThread, StopsWhileTheSourceStalls) {
  MonotonicClock clock;
  MockMediaProfile profile = filmOf(100);
  profile.stall_after_packets = 6;  // before the queue is full
  profile.stall = std::chrono::hours(1);
  FilmFeed feed(backends(profile, clock), kCapacity);
  feed.open({.url = "mock"});
  feed.startThread();
  while (!feed.take()) clock.sleepUntil(clock.now() + std::chrono::milliseconds(1));
  clock.sleepUntil(clock.now() + std::chrono::milliseconds(20));
  feed.stop();
  EXPECT_EQ(feed.state(), State::Closed);
}

TEST(FilmFeedThread, StopsWhileItWaitsForALostSource) {
  MonotonicClock clock;
  MockMediaProfile profile = filmOf(100);
  profile.remote = profile.live = true;
  profile.lose_after_packets = 5;  // each time
  FilmFeed feed(backends(profile, clock), kCapacity);
  feed.open({.url = "mock"});
  feed.startThread();
  while (feed.state() != State::Reconnecting) clock.sleepUntil(clock.now() + std::chrono::milliseconds(1));
  feed.stop();
  EXPECT_EQ(feed.state(), State::Closed);
}

TEST(FilmFeedThread, ReadsTheWholeFilmWhileItIsTaken) {
  MonotonicClock clock;
  FilmFeed feed(backends(filmOf(200), clock), kCapacity);
  feed.open({.url = "mock"});
  feed.startThread();
  int taken = 0;
  for (bool ended = false; !ended;) {
    ended = feed.state() == State::Ended;  // before taking: everything before the end is then queued
    while (const auto pair = feed.take()) {
      EXPECT_EQ(pair->color.pts, MediaTime(taken * kPeriod));
      ++taken;
    }
    clock.sleepUntil(clock.now() + std::chrono::microseconds(100));
  }
  EXPECT_EQ(taken, 200);
}

class PlayheadTest : public FilmFeedTest {
 protected:
  int present() const { return static_cast<int>(head_.present().color.pts.time_since_epoch() / kPeriod); }
  bool refill() {
    workAll();
    return head_.refill(*feed_);
  }
  Playhead head_;
};

TEST_F(PlayheadTest, GoesToTheNewestPairThatIsDueAndCountsTheRest) {
  open(filmOf(100));
  refill();
  head_.begin();
  EXPECT_EQ(present(), 0);
  EXPECT_EQ(head_.advance(MediaTime(kPeriod - Duration(1)), *feed_), 0u);
  EXPECT_EQ(head_.advance(MediaTime(kPeriod), *feed_), 1u);
  EXPECT_EQ(present(), 1);
  workAll();
  EXPECT_EQ(head_.advance(MediaTime(4 * kPeriod), *feed_), 3u);
  EXPECT_EQ(present(), 4);
}

TEST_F(PlayheadTest, AFeedThatIsEmptyForTheMomentIsNotAtItsEnd) {
  FilmFeed& feed = open(filmOf(100));
  feed.work();  // opens
  feed.work();  // one pair
  EXPECT_TRUE(head_.refill(feed));
  EXPECT_EQ(head_.ahead().size(), 1u);
  EXPECT_FALSE(head_.last());
}

TEST_F(PlayheadTest, KnowsThatNothingFollowsOnlyWhenTheLastPairIsTaken) {
  open(filmOf(6));
  refill();
  EXPECT_TRUE(head_.filled());
  EXPECT_FALSE(head_.last());  // two more pairs wait in the feed
  head_.begin();
  head_.begin();
  refill();
  EXPECT_FALSE(head_.last());  // full: it has not yet learnt that the feed has ended
  head_.begin();
  EXPECT_FALSE(refill());
  EXPECT_TRUE(head_.last());
  EXPECT_EQ(head_.ahead().size(), 3u);
}

}  // namespace
}  // namespace relievo::test
