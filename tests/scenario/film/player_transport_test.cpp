// SPDX-License-Identifier: Apache-2.0
// Rates, steps and places in films, and where films go on, in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "app/player/film/resume.h"
#include "tests/scenario/film/player_transport.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// 32 x 24 pixels in a box that is twice as wide as high.
TEST_F(PlayerTransport, TheWindowIsToldThePicturesSizeInTheShapeOfItsBox) {
  std::vector<AnnouncedFilm> told;
  bench_.display.announced = [&](const AnnouncedFilm& film) { told.push_back(film); };
  playsWell();
  bench_.config.volume = DisplayVolume{160, 80, 40};
  bench_.config.source.url = "/films/a film.mkv";
  bench_.sources["/films/a film.mkv"] = PlayerBench::film(25);
  playsWell();
  EXPECT_EQ(told, (std::vector<AnnouncedFilm>{{"film", 32, 24}, {"a film.mkv", 48, 24}}));
}

TEST_F(PlayerTransport, FullScreenIsTheWindowsAndEscapeLeavesTheFilmPlaying) {
  std::vector<FullScreen> wishes;
  bench_.display.filled = [&](FullScreen wish) { wishes.push_back(wish); };
  bench_.press(0.5, KEY_F);
  bench_.press(1.0, KEY_ESC);
  playsWell();
  EXPECT_EQ(wishes, (std::vector{FullScreen::Toggle, FullScreen::Off}));
  EXPECT_EQ(bench_.report.frames_shown, 100u);
}

// The page of keys covers the picture, so that a viewer would not see what a key does to the film. Arrows turn the
// page, any other key closes it.
TEST_F(PlayerTransport, AKeyPressedOverThePageOfKeysLeavesTheFilmAsItIs) {
  std::vector<FullScreen> wishes;
  bench_.display.filled = [&](FullScreen wish) { wishes.push_back(wish); };
  double at_s = 0.2;
  for (const int closing : {KEY_SPACE, KEY_OK, KEY_F, KEY_Q, KEY_T}) {
    bench_.press(at_s, KEY_H);
    bench_.press(at_s + 0.1, KEY_RIGHT);
    bench_.press(at_s + 0.2, KEY_UP);
    bench_.press(at_s + 0.3, static_cast<std::uint16_t>(closing));
    at_s += 0.5;
  }
  bench_.press(at_s, KEY_F);
  bench_.press(at_s + 0.2, KEY_PAUSE);
  bench_.press(at_s + 0.4, KEY_Q);
  playsWell();
  EXPECT_THAT(wishes, SizeIs(1)) << "of a key after the page";
  EXPECT_THAT(bench_.states(), testing::EndsWith("playing paused idle"));
  EXPECT_EQ(std::ranges::count(bench_.report.states, PlayerState::Paused), 1);
  EXPECT_THAT(bench_.report.seeks, IsEmpty());
}

TEST_F(PlayerTransport, AStepBackShowsThePictureBeforeAndStands) {
  bench_.press(1.0, KEY_PAUSE);
  for (int i = 0; i < 3; ++i) bench_.press(2.0 + i, KEY_COMMA);
  bench_.press(6.0, KEY_DOT);
  bench_.press(7.0, KEY_STOP);
  playsWell();
  EXPECT_THAT(bench_.states(), testing::HasSubstr("paused seeking buffering paused seeking buffering paused"));
  ASSERT_THAT(bench_.report.seeks, SizeIs(0)) << "it is no seek of the viewer's";
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown), 25 + 3 + 1, 1);
}

// The picture of 3.96 s stands until 16 s.
TEST_F(PlayerTransport, ASeekIntoALongPictureGoesOnFromThere) {
  bench_.sources["film"] = PlayerBench::film(1000);
  for (int k = 100; k < 400; ++k) {
    for (MockTrack& track : bench_.sources["film"].tracks) track.missing.push_back(k);
  }
  bench_.press(18.0, KEY_PAUSE);
  for (int i = 0; i < 3; ++i) bench_.press(19.0 + i, KEY_LEFT);
  bench_.press(22.0, KEY_STOP);
  playsWell();
  ASSERT_THAT(bench_.report.seeks, SizeIs(3));
  const std::array targets_s{13.0, 8.0, 3.0}, pictures_s{3.96, 3.96, 3.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(bench_.report.seeks[i].target_s, targets_s[i], 0.05) << i;
    EXPECT_NEAR(bench_.report.seeks[i].picture_s.value_or(0), pictures_s[i], 0.05) << i;
  }
}

TEST_F(PlayerTransport, WhereNoSeekIsPossibleAMarkedPartIsForgotten) {
  bench_.sources["film"].live = true;
  bench_.press(1.0, KEY_L);
  bench_.press(2.0, KEY_L);
  playsWell();
  EXPECT_EQ(std::ranges::count(bench_.report.states, PlayerState::Seeking), 1);
  EXPECT_GT(bench_.report.media_s, 3.5) << "but for what was read ahead";
}

TEST_F(PlayerTransport, WhereNothingIsPlayedTheDeviceIsAtRest) {
  bench_.config.stays = true;
  bench_.config.duration = std::chrono::seconds(8);
  bench_.press(2.0, KEY_STOP);
  bench_.press(5.0, KEY_PLAY);
  std::vector<double> ticks_s;
  double left_n = -1;
  bench_.haptic.position_mm = [&](double t) {
    const double now_s = toSeconds(bench_.clock.now().time_since_epoch());
    if (!ticks_s.empty() && now_s - ticks_s.back() > 1) left_n = glm::length(bench_.hand->force());
    ticks_s.push_back(now_s);
    return glm::dvec3(0, 0, t < 0.3 ? 25 : 15);
  };
  playsWell();
  EXPECT_GT(ticks_s.size(), 4000u);
  EXPECT_TRUE(std::ranges::none_of(ticks_s, [](double t) { return t > 2.1 && t < 5.0; }));
  EXPECT_EQ(left_n, 0.0) << "in the motors, from one film to the next";
}

TEST_F(PlayerTransport, SlowMotionShowsEveryPictureLongerAndIsFelt) {
  aFingerInside();
  bench_.press(1.0, KEY_SLOW);  // 1/2 from 1 s on: 3 s take 6
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.report.frames_dropped, 0u);
  EXPECT_NEAR(bench_.report.wall_s, 7.0, 0.05);
  EXPECT_GT(bench_.report.haptic.contact_ticks, 6000u);
  EXPECT_EQ(bench_.faults("depth delayed"), 0u);
}

TEST_F(PlayerTransport, SlowerAndSlowerAndPlayIsTheUsualRateAgain) {
  for (int i = 0; i < 5; ++i) bench_.press(1.0, KEY_SLOW);  // 1/8 is the least
  bench_.press(9.0, KEY_PLAY);                              // a second of film later
  playsWell();
  EXPECT_NEAR(bench_.report.wall_s, 1 + 8 + 2, 0.05);
  EXPECT_EQ(bench_.report.frames_shown, 100u);
}

TEST_F(PlayerTransport, FastForwardShowsKeyFramesAtItsRateAndIsNotFelt) {
  bench_.sources["film"] = PlayerBench::film(2000);  // 80 s
  bench_.sources["film"].tracks[0].keyframe_interval = 12;
  bench_.sources["film"].tracks[1].keyframe_interval = 12;
  aFingerInside();
  bench_.press(1.0, KEY_FASTFORWARD);  // 2
  bench_.press(1.0, KEY_FASTFORWARD);  // 4
  playsWell();
  EXPECT_NEAR(bench_.report.wall_s, 1 + 79.0 / 4, 0.6);
  // A key frame each 0.48 s of film: 25 before, then 165.
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown), 25 + 165, 3);
  EXPECT_EQ(bench_.report.pairs.mismatched, 0u);
  EXPECT_NEAR(static_cast<double>(bench_.report.haptic.contact_ticks), 700, 100);  // until then
  EXPECT_LE(bench_.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
  EXPECT_THAT(bench_.report.faults, IsEmpty());
}

TEST_F(PlayerTransport, WhereEveryFrameIsAKeyFrameOnlySoManyAreShownAsTheEyeFollows) {
  bench_.sources["film"] = PlayerBench::film(2000);
  for (int i = 0; i < 6; ++i) bench_.press(1.0, KEY_FASTFORWARD);  // 16
  playsWell();
  EXPECT_NEAR(bench_.report.wall_s, 1 + 79.0 / 16, 0.6);
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown), 25 + 50, 5);  // ten a second
  EXPECT_LE(bench_.report.frames_dropped, 1u);
}

TEST_F(PlayerTransport, WithoutAnotherKeyFrameItPlaysOnAtItsUsualRate) {
  bench_.sources["film"].tracks[0].keyframe_interval = 200;  // the first picture only
  bench_.press(1.0, KEY_FASTFORWARD);
  bench_.press(1.0, KEY_FASTFORWARD);
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.1);
  EXPECT_EQ(bench_.faults("no more key frames"), 1u);
}

TEST_F(PlayerTransport, FastForwardComesToTheEndAtItsRateBehindTheLastKeyFrame) {
  bench_.sources["film"] = PlayerBench::film(500);  // 20 s, key frames at 0, 8 and 16 s
  bench_.sources["film"].tracks[0].keyframe_interval = 200;
  bench_.press(1.0, KEY_FASTFORWARD);
  playsWell();
  EXPECT_NEAR(bench_.report.wall_s, 1 + (20 - 8) / 2.0, 0.1);
  EXPECT_EQ(bench_.report.frames_shown, 25u + 2u);
}

TEST_F(PlayerTransport, OutOfFastForwardItGoesOnExactlyThereAndIsFeltAgain) {
  bench_.sources["film"] = PlayerBench::film(2000);
  bench_.sources["film"].tracks[0].keyframe_interval = 50;
  bench_.sources["film"].tracks[1].keyframe_interval = 50;
  aFingerInside();
  bench_.press(1.0, KEY_FASTFORWARD);
  bench_.press(6.0, KEY_PAUSE);
  bench_.press(8.0, KEY_PLAY);
  bench_.press(9.0, KEY_STOP);
  playsWell();
  EXPECT_THAT(bench_.states(), HasSubstr("seeking buffering playing seeking buffering paused playing idle"));
  EXPECT_NEAR(static_cast<double>(bench_.report.haptic.contact_ticks), 700 + 2900, 200);  // not in the 5 s between
  EXPECT_NEAR(bench_.report.media_s, 1 + 2 * 5 + 1, 2.5);
}

TEST_F(PlayerTransport, ALiveSourceCannotRushAndPlaysOn) {
  bench_.sources["film"].live = true;
  bench_.press(1.0, KEY_FASTFORWARD);
  playsWell();
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.05);
  EXPECT_EQ(bench_.report.frames_shown, 100u);
}

TEST_F(PlayerTransport, AStepShowsTheNextPictureAndStands) {
  aFingerInside();
  bench_.press(1.0, KEY_DOT);
  for (int i = 0; i < 4; ++i) bench_.press(2.0 + i, KEY_DOT);
  bench_.press(7.0, KEY_STOP);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing paused idle");
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown), 25 + 5, 1);
  EXPECT_EQ(bench_.report.frames_dropped, 0u) << "a step passes over no picture";
  EXPECT_GT(bench_.report.haptic.contact_ticks, 6000u);
  EXPECT_LE(bench_.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
  EXPECT_EQ(bench_.faults("depth delayed"), 0u);
}

TEST_F(PlayerTransport, AStepBeyondTheLastPictureStands) {
  bench_.press(3.9, KEY_PAUSE);
  for (int i = 0; i < 20; ++i) bench_.press(4.0 + i, KEY_DOT);
  bench_.press(30.0, KEY_STOP);
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
}

TEST_F(PlayerTransport, ADigitGoesToItsShareOfTheFilm) {
  bench_.sources["film"] = PlayerBench::film(1000);  // 40 s
  bench_.press(1.0, KEY_5);
  bench_.press(2.0, KEY_NUMERIC_9);
  bench_.press(3.0, KEY_STOP);
  playsWell();
  ASSERT_THAT(bench_.report.seeks, SizeIs(2));
  EXPECT_NEAR(bench_.report.seeks[0].picture_s.value_or(-1), 20.0, 0.05);
  EXPECT_NEAR(bench_.report.seeks[1].picture_s.value_or(-1), 36.0, 0.05);
}

TEST_F(PlayerTransport, OfALiveSourceThereIsNoShare) {
  bench_.sources["film"].live = true;
  bench_.press(1.0, KEY_5);
  playsWell();
  EXPECT_THAT(bench_.report.seeks, IsEmpty());
}

// Gives ten repeats of a key at once, after a second.
class HeldKey final : public RemoteInput {
 public:
  explicit HeldKey(Clock& clock) : from_(clock.now() + std::chrono::seconds(1)) {}

 private:
  Result<void> openRemote() override { return {}; }
  Result<std::optional<KeyEvent>> nextKey(MonotonicTime now) override {
    if (now < from_ || left_ == 0) return std::nullopt;
    --left_;
    return KeyEvent{KEY_RIGHT, KeyEvent::Action::Repeat, now};
  }
  void closeRemote() noexcept override {}

  MonotonicTime from_;
  int left_ = 10;
};

TEST_F(PlayerTransport, AHeldKeySeeksOnOnlyWhenItsPictureHasBeenShown) {
  bench_.sources["film"] = PlayerBench::film(1000);  // 40 s
  bench_.config.duration = std::chrono::seconds(3);
  bench_.make_remote = [](Clock& clock) { return std::make_unique<HeldKey>(clock); };
  playsWell();
  ASSERT_THAT(bench_.report.seeks, SizeIs(1));
  EXPECT_NEAR(bench_.report.seeks[0].picture_s.value_or(-1), 6.0, 0.1);
}

TEST_F(PlayerTransport, AHeldOkIsInfoAndAShortOnePauses) {
  bench_.press(1.0, KEY_OK, 2.0);
  bench_.press(3.5, KEY_ENTER, 0.1);
  bench_.press(4.5, KEY_STOP);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing paused idle");
  EXPECT_NEAR(bench_.report.media_s, 3.6, 0.05);
}

class PlayerResume : public PlayerTransport {
 protected:
  PlayerResume() { bench_.config.resume_path = path_; }
  ~PlayerResume() override { std::filesystem::remove(path_); }
  FileWriter files_{FileWriter::Where::AtOnce};
  const std::string path_ = testing::TempDir() + "player-resume-" + std::to_string(::getpid()) + ".json";
};

TEST_F(PlayerResume, AFilmGoesOnWhereItWasLeft) {
  bench_.sources["film"] = PlayerBench::film(1000);
  bench_.press(12.0, KEY_STOP);
  playsWell();
  bench_.keys.clear();
  bench_.config.duration = std::chrono::seconds(3);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering seeking buffering playing idle");
  EXPECT_THAT(bench_.report.seeks, IsEmpty());  // nobody asked
  EXPECT_NEAR(toSeconds(Resume(path_, files_).find("film").value_or(MediaTime{})), 15.0, 0.1);
}

TEST_F(PlayerResume, AFilmThatHasEndedBeginsAtItsBeginning) {
  playsWell();
  EXPECT_FALSE(Resume(path_, files_).find("film"));
  playsWell();
  EXPECT_NEAR(bench_.report.media_s, 4.0, 0.1);
}

// The film's position is that of the picture, no matter how long the picture has stood still.
TEST_F(PlayerResume, AFilmThatStandsIsKeptWhereItStands) {
  bench_.sources["film"] = PlayerBench::film(1000);
  bench_.sources["film"].remote = true;
  bench_.sources["film"].lose_after_packets = 500;  // 10 s of both tracks
  MockMediaProfile away = bench_.sources["film"];
  away.fail_open = ErrorCode::Io;
  bench_.found_again = {away};
  bench_.press(20.0, KEY_STOP);
  playsWell();
  EXPECT_NEAR(toSeconds(Resume(path_, files_).find("film").value_or(MediaTime{})), 9.96, 0.2);
  EXPECT_NEAR(bench_.report.media_s, 10.0, 0.2);
}

TEST_F(PlayerResume, OfAListThatWasSeenToItsEndNoFilmIsKept) {
  aList();
  playsWell();
  for (const char* film : {"./a", "./b", "./c"}) EXPECT_FALSE(Resume(path_, files_).find(film)) << film;
}

TEST_F(PlayerResume, AListGoesOnWithTheFilmThatWasSeenLast) {
  aList();
  bench_.sources["./b"] = PlayerBench::film(500);
  bench_.press(6.0, KEY_STOP);
  playsWell();
  bench_.keys.clear();
  playsWell();
  EXPECT_THAT(bench_.report.films, ElementsAre("./b", "./c"));
  EXPECT_NEAR(bench_.report.media_s, 15 + 3, 0.2);  // 5 s of b were seen
}

}  // namespace
}  // namespace relievo
