// SPDX-License-Identifier: Apache-2.0
// A film alone, in simulated time: without a player, a screen or a device.
#include "app/player/film/film_playback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "drivers/mock/mock.h"
#include "platform/log.h"

namespace relievo {
namespace {

using Opening = FilmPlayback::Opening;
using Progress = FilmPlayback::Progress;

constexpr Duration kPeriod = std::chrono::milliseconds(40);

MockMediaProfile filmOf(int frames) {
  const MockTrack color{.width = 16, .height = 12, .model = ColorModel::Yuv, .frames = frames, .frame_period = kPeriod};
  const MockTrack depth{.width = 16, .height = 12, .frames = frames, .frame_period = kPeriod};
  return {.tracks = {color, depth}};
}

class FilmPlaybackTest : public testing::Test {
 protected:
  FilmPlaybackTest() { setLogLevel(LogLevel::Error); }

  void open(const std::string& url) {
    film_.open({.url = url});
    film_.read();
    ASSERT_EQ(film_.opening(), Opening::Opened);
    film_.opened();
  }
  // Reads until the film can start, and starts it with its first picture.
  void start() {
    film_.read();
    ASSERT_EQ(film_.filling(), Progress::Ready);
    film_.takeFirst();
    ASSERT_TRUE(film_.start(clock_.now()));
  }
  // Plays until the film stops by itself, or for `most_ms`.
  Progress play(int most_ms) {
    for (int i = 0; i < most_ms; ++i) {
      clock_.sleepUntil(clock_.now() + std::chrono::milliseconds(1));
      film_.read();
      shown_ += film_.advance(clock_.now());
      if (const Progress progress = film_.going(clock_.now()); progress != Progress::Goes) return progress;
    }
    return Progress::Goes;
  }
  [[nodiscard]] double place() const {
    const auto place = film_.place(clock_.now());
    return place ? toSeconds(*place) : -1;
  }

  ManualClock clock_;
  std::map<std::string, MockMediaProfile> sources_{{"film", filmOf(50)}, {"other", filmOf(25)}};
  Journal journal_{clock_};
  FilmPlayback film_{{.make_source = [this](const std::string&) { return makeMockSources(sources_, clock_); },
                      .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32}); },
                      .clock = &clock_},
                     nullptr,
                     clock_,
                     journal_};
  std::size_t shown_ = 0;
};

TEST_F(FilmPlaybackTest, GoesPictureByPictureToItsEnd) {
  open("film");
  start();
  EXPECT_EQ(play(10'000), Progress::Over);
  EXPECT_EQ(shown_, 49U);  // and the first
  film_.countPlayed(clock_.now());
  EXPECT_EQ(film_.played(), 50 * kPeriod);
}

TEST_F(FilmPlaybackTest, NothingOfTheFilmBeforeIsTrueOfTheNext) {
  open("film");
  start();
  film_.setRate(0.5, clock_.now());
  film_.wishHeld(true);
  EXPECT_EQ(film_.info().duration, 50 * kPeriod);
  film_.close(clock_.now());
  film_.open({.url = "other"});
  EXPECT_EQ(film_.opening(), Opening::Waits);
  EXPECT_EQ(film_.info().duration, Duration(0));
  EXPECT_FALSE(film_.info().has_depth);
  EXPECT_FALSE(film_.begun());
  EXPECT_FALSE(film_.held());
  EXPECT_EQ(film_.rate(), 1);
  EXPECT_TRUE(film_.picture().color.empty());
  EXPECT_EQ(film_.place(clock_.now()), std::nullopt);
}

TEST_F(FilmPlaybackTest, AnOpeningOfMoreThanFiveSecondsSaysOnceWhatItWaitsFor) {
  setLogLevel(LogLevel::Warning);
  const auto saidAfter = [&](int seconds) {
    testing::internal::CaptureStderr();
    clock_.sleepUntil(clock_.now() + std::chrono::seconds(seconds));
    film_.noteWait(clock_.now());
    return testing::internal::GetCapturedStderr();
  };
  film_.open({.url = "film"});
  EXPECT_EQ(saidAfter(0), "");
  EXPECT_EQ(saidAfter(5), "");
  EXPECT_THAT(saidAfter(1), testing::HasSubstr("waiting for \"film\" (up to 30 s)"));
  EXPECT_EQ(saidAfter(10), "");
  film_.close(clock_.now());
  film_.open({.url = "other", .depth_url = "depth"});
  EXPECT_EQ(saidAfter(1), "") << "of another film";
  EXPECT_THAT(saidAfter(6), testing::HasSubstr("waiting for \"other\" or \"depth\" (up to 30 s)"));
}

TEST_F(FilmPlaybackTest, ASourceThatCannotBeOpenedHasFailedByItsName) {
  film_.open({.url = "missing"});
  film_.read();
  EXPECT_EQ(film_.opening(), Opening::Failed);
  EXPECT_EQ(film_.failure().thing, "missing");
  EXPECT_TRUE(film_.isOpen());
  film_.close(clock_.now());
  EXPECT_FALSE(film_.isOpen());
}

TEST_F(FilmPlaybackTest, HeldItStandsAndPausesAreNotCounted) {
  open("film");
  film_.wishHeld(true);
  start();
  EXPECT_EQ(film_.nextPicture(clock_.now()), MonotonicTime::max());
  EXPECT_EQ(play(500), Progress::Goes);
  EXPECT_EQ(shown_, 0U);
  ASSERT_TRUE(film_.resume(clock_.now()));
  EXPECT_EQ(play(400), Progress::Goes);
  ASSERT_TRUE(film_.pause(clock_.now()));
  EXPECT_EQ(play(500), Progress::Goes);
  EXPECT_EQ(shown_, 10U);
  EXPECT_EQ(film_.played(), std::chrono::milliseconds(400));
  film_.stepOn(clock_.now());
  EXPECT_DOUBLE_EQ(place(), 0.44);
  EXPECT_EQ(film_.advance(clock_.now()), 1U) << "it is to be shown";
  EXPECT_EQ(film_.advance(clock_.now()), 0U);
}

TEST_F(FilmPlaybackTest, SeeksAddUpAndTheFirstPictureAfterThemDoesNotContinueTheLast) {
  open("film");
  start();
  EXPECT_TRUE(film_.takeJump());
  EXPECT_EQ(play(100), Progress::Goes);
  EXPECT_FALSE(film_.takeJump());
  EXPECT_NE(film_.placeToKeep(clock_.now()), std::nullopt);
  film_.seek(film_.goal(clock_.now()) + std::chrono::milliseconds(400), clock_.now());
  film_.seek(film_.goal(clock_.now()) + std::chrono::milliseconds(400), clock_.now());
  EXPECT_EQ(film_.goal(clock_.now()), mediaTime(0.9));
  EXPECT_EQ(film_.placeToKeep(clock_.now()), std::nullopt) << "on the way elsewhere";
  EXPECT_FALSE(film_.arriving(clock_.now()));
  film_.read();
  EXPECT_TRUE(film_.arriving(clock_.now()));
  start();
  EXPECT_EQ(film_.picture().color.pts, mediaTime(0.92));
  EXPECT_TRUE(film_.takeJump());
}

TEST_F(FilmPlaybackTest, WhatRushesByIsNotFelt) {
  open("film");
  start();
  EXPECT_EQ(play(1), Progress::Goes);
  EXPECT_FALSE(film_.depth().present.empty());
  EXPECT_TRUE(film_.depth().expected);
  EXPECT_EQ(film_.depth().ahead_count, Playhead::kAhead);
  film_.setRate(2, clock_.now());
  EXPECT_TRUE(film_.depth().present.empty());
  EXPECT_FALSE(film_.depth().expected);
}

// The reader does nothing for a while: the picture freezes, and so does the position that the viewer sees.
TEST_F(FilmPlaybackTest, AFilmThatComesTooSlowlyStandsAtItsPicture) {
  open("film");
  start();
  Progress progress = Progress::Goes;
  for (int i = 0; i < 1000 && progress == Progress::Goes; ++i) {
    clock_.sleepUntil(clock_.now() + std::chrono::milliseconds(1));
    static_cast<void>(film_.advance(clock_.now()));
    progress = film_.going(clock_.now());
  }
  EXPECT_EQ(progress, Progress::Starved);
  const MediaTime stands = film_.picture().color.pts;
  clock_.sleepUntil(clock_.now() + std::chrono::seconds(1));
  EXPECT_EQ(film_.place(clock_.now()), stands);
  EXPECT_GT(film_.clock()->at(clock_.now()), stands) << "what is felt fades by the clock";
  start();
  EXPECT_EQ(film_.picture().color.pts, stands + kPeriod);
}

}  // namespace
}  // namespace relievo
