// SPDX-License-Identifier: Apache-2.0
// The sound of a FilmFeed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/unit/media/feed/film_feed_stage.h"

namespace relievo::test {
namespace {

using testing::ElementsAre;

// An audio track comes in chunks of 20 ms.
class FilmFeedSound : public FilmFeedTest {
 protected:
  static constexpr Duration kPiece = std::chrono::milliseconds(20);
  FilmFeed& openWithSound(int frames, Duration late = Duration(0)) {
    MockMediaProfile profile = filmOf(frames);
    profile.tracks.push_back({.kind = StreamKind::Audio,
                              .frames = 2 * frames,
                              .frame_period = kPiece,
                              .keyframe_interval = 16,
                              .late = late});
    PairReader::Backends parts = backends(std::move(profile), clock_);
    parts.make_audio_decoder = makeMockAudioDecoder;
    feed_ = std::make_unique<FilmFeed>(std::move(parts), kCapacity);
    feed_->open({.url = "mock", .sound = AudioFormat{}});
    return *feed_;
  }
  // Numbers of the chunks that can be taken without further work.
  std::vector<int> takeSound() {
    std::vector<int> taken;
    while (const auto chunk = feed_->takeSound())
      taken.push_back(static_cast<int>(chunk->pts.time_since_epoch() / kPiece));
    return taken;
  }
};

TEST_F(FilmFeedSound, IsDecodedAheadNoFurtherThanItsBound) {
  FilmFeed& feed = openWithSound(100);
  workAll();
  EXPECT_EQ(feed.info().sound_codec, "mock");
  const std::vector<int> taken = takeSound();
  EXPECT_EQ(taken.size(), static_cast<std::size_t>(FilmFeed::kSoundAhead / kPiece));
  for (std::size_t i = 0; i < taken.size(); ++i) EXPECT_EQ(taken[i], static_cast<int>(i));
  EXPECT_THAT(takeAll(), ElementsAre(0, 1, 2, 3)) << "the pictures are read as ever";
}

TEST_F(FilmFeedSound, ThatNobodyTakesHoldsNoPicture) {
  openWithSound(100);
  std::vector<int> pictures;
  for (int round = 0; round < 30; ++round) {
    workAll();
    for (const int picture : takeAll()) pictures.push_back(picture);
  }
  EXPECT_EQ(pictures.size(), 100u);
}

TEST_F(FilmFeedSound, IsTakenToItsEndAfterThePictures) {
  openWithSound(50);
  std::vector<int> sound;
  for (int round = 0; round < 30; ++round) {
    workAll();
    static_cast<void>(takeAll());
    for (const int piece : takeSound()) sound.push_back(piece);
  }
  EXPECT_EQ(sound.size(), 100u);
  EXPECT_TRUE(feed_->hasSoundUntil(mediaTime(99)));
}

TEST_F(FilmFeedSound, IsSaidToBeThereOrNotToCome) {
  FilmFeed& feed = openWithSound(200, std::chrono::milliseconds(800));
  feed.work();
  EXPECT_FALSE(feed.hasSoundUntil(mediaTime(0.3)));
  workAll();
  EXPECT_TRUE(feed.hasSoundUntil(mediaTime(0.3)));
  EXPECT_FALSE(takeSound().empty());
  FilmFeed& too_late = openWithSound(1000, std::chrono::seconds(30));
  workAll();
  EXPECT_TRUE(too_late.hasSoundUntil(mediaTime(0.3))) << "it is too far ahead to wait for";
  EXPECT_TRUE(takeSound().empty());
}

TEST_F(FilmFeedSound, AfterASeekBeginsAtTheTarget) {
  FilmFeed& feed = openWithSound(200);
  workAll();
  feed.seek(MediaTime(50 * kPeriod));
  EXPECT_TRUE(takeSound().empty()) << "what was read ahead is dropped";
  workAll();
  const std::vector<int> taken = takeSound();
  ASSERT_FALSE(taken.empty());
  EXPECT_EQ(taken.front(), 100) << "not at the key frame before";
}

TEST_F(FilmFeedSound, IsLeftOutForWhoDoesNotWantIt) {
  openWithSound(20);
  feed_->open({.url = "mock"});
  workAll();
  EXPECT_EQ(feed_->info().sound_codec, "");
  EXPECT_TRUE(takeSound().empty());
  EXPECT_TRUE(feed_->hasSoundUntil(mediaTime(1)));
}

// A sound output that has told its own while the film plays.
TEST_F(FilmFeedSound, IsDecodedToAnotherFormatFromThereOn) {
  FilmFeed& feed = openWithSound(200);
  workAll();
  ASSERT_FALSE(takeSound().empty());
  workAll();
  feed.setSoundFormat({.rate_hz = 24'000, .channels = 1});
  EXPECT_FALSE(feed.takeSound()) << "what was read ahead is dropped";
  EXPECT_FALSE(feed.hasSoundUntil(mediaTime(1)));
  workAll();
  const auto chunk = feed.takeSound();
  ASSERT_TRUE(chunk);
  EXPECT_EQ(chunk->samples.size(), 480u) << "20 ms";
}

}  // namespace
}  // namespace relievo::test
