// SPDX-License-Identifier: Apache-2.0
// Films with sound in simulated time: each picture against the very sample that is in the air when it is shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/scenario/player_bench.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using testing::IsEmpty;

// The sound that is in the air is told by its samples (PlayerBench::soundTrack), the picture by the film's frame that
// is shown: neither is asked of the player.
class PlayerSound : public testing::Test {
 protected:
  struct Moment {
    double time_s = 0;
    std::optional<double> heard_s;  // the film's time of the sound that is in the air
  };

  PlayerSound() {
    bench_.with_haptic = false;
    bench_.audio.emplace();
    bench_.display.shown = [this] {
      const MonotonicTime now = bench_.clock.now();
      std::optional<double> heard_s;
      if (bench_.ear->heard) {
        if (const auto sample = bench_.ear->heard(now)) heard_s = 1e3 * static_cast<double>(*sample);
      }
      moments_.push_back({toSeconds(now.time_since_epoch()), heard_s});
    };
  }
  void film(int frames) {
    bench_.sources["film"] = PlayerBench::film(frames);
    bench_.sources["film"].tracks.push_back(PlayerBench::soundTrack(frames));
  }
  MockTrack& sound() { return bench_.sources["film"].tracks[2]; }
  void playsWell() {
    const auto played = bench_.run();
    ASSERT_TRUE(played) << played.error().thing << ": " << played.error().error.message;
    ASSERT_EQ(bench_.report.frames_dropped, 0u);
  }
  // Of the sound against picture k of a film that is shown from its beginning without a break.
  [[nodiscard]] double offsetMs(std::size_t k) const {
    const double picture_s = toSeconds(PlayerBench::kPeriod) * static_cast<double>(k);
    return moments_[k].heard_s ? 1e3 * (*moments_[k].heard_s - picture_s) : std::nan("");
  }
  // The worst of pictures from..to.
  [[nodiscard]] double worstOffsetMs(std::size_t from, std::size_t to) const {
    double worst = 0;
    for (std::size_t k = from; k < to; ++k) {
      if (!(std::abs(offsetMs(k)) <= worst)) worst = std::isnan(offsetMs(k)) ? 1e9 : std::abs(offsetMs(k));
    }
    return worst;
  }
  // Takes out what was shown from..to, by the machine's time.
  std::vector<Moment> takeMoments(double from_s, double to_s) {
    std::vector<Moment> taken;
    std::erase_if(moments_, [&](const Moment& moment) {
      const bool there = moment.time_s >= from_s && moment.time_s < to_s;
      if (there) taken.push_back(moment);
      return there;
    });
    return taken;
  }
  [[nodiscard]] std::size_t silentMoments() const {
    return static_cast<std::size_t>(
        std::count_if(moments_.begin(), moments_.end(), [](const Moment& m) { return !m.heard_s; }));
  }

  PlayerBench bench_;
  std::vector<Moment> moments_;  // one for each picture that is shown, the first while the film does not run yet
};

TEST_F(PlayerSound, IsHeardWithItsPicturesFromTheFirstToTheLast) {
  film(100);
  playsWell();
  ASSERT_EQ(moments_.size(), 100u);
  EXPECT_LT(worstOffsetMs(1, 100), 1.0);
  EXPECT_EQ(bench_.report.sound.underruns, 0u);
  EXPECT_EQ(bench_.report.sound.realigned, 0u);
  EXPECT_EQ(bench_.report.sound.rate_hz, 48000);
  EXPECT_EQ(bench_.report.film.sound_codec, "mock");
  EXPECT_THAT(bench_.report.faults, IsEmpty());
}

TEST_F(PlayerSound, TheVolumeIsAFactorOnEverySample) {
  bench_.config.volume_percent = 50;  // an eighth
  film(50);
  playsWell();
  for (std::size_t k = 5; k < 50; ++k) {
    ASSERT_TRUE(moments_[k].heard_s) << k;
    EXPECT_NEAR(*moments_[k].heard_s, 0.125 * 0.04 * static_cast<double>(k), 0.125e-3) << k;
  }
}

TEST_F(PlayerSound, MutedIsSilentInTimeAndComesBackInTime) {
  bench_.config.keys = KeyTable::parse("[always]\nM = \"mute\"\n", "keys").value();
  film(100);
  bench_.press(1.0, KEY_M);
  bench_.press(2.0, KEY_M);
  playsWell();
  for (std::size_t k = 27; k < 50; ++k) EXPECT_EQ(moments_[k].heard_s.value_or(0), 0) << k;
  EXPECT_LT(worstOffsetMs(60, 100), 1.0);
  EXPECT_EQ(bench_.report.sound.realigned, 0u);
}

TEST_F(PlayerSound, ADelayMovesTheSoundAlone) {
  bench_.config.keys = KeyTable::parse("[always]\nA = \"audio-delay +0.2\"\n", "keys").value();
  film(150);
  bench_.press(1.0, KEY_A);
  playsWell();
  EXPECT_LT(worstOffsetMs(1, 25), 1.0);
  for (std::size_t k = 75; k < 150; ++k) EXPECT_NEAR(offsetMs(k), -200, 2) << k;
}

TEST_F(PlayerSound, AnotherTrackIsHeardFromWhereTheFilmIs) {
  bench_.config.keys = KeyTable::parse("[always]\nA = \"audio\"\n", "keys").value();
  film(150);
  MockTrack other = PlayerBench::soundTrack(150);
  other.sound = [](double seconds, int) { return static_cast<float>(0.5 + seconds * 1e-3); };  // 500 s ahead
  bench_.sources["film"].tracks.push_back(other);
  bench_.press(2.0, KEY_A);
  const auto played = bench_.run();
  ASSERT_TRUE(played);
  ASSERT_GE(moments_.size(), 140u);
  const Moment& last = moments_[moments_.size() - 5];
  ASSERT_TRUE(last.heard_s);
  EXPECT_NEAR(*last.heard_s - 500, 0.04 * 145, 0.05);
  EXPECT_EQ(bench_.report.sound.underruns, 0u);
}

TEST_F(PlayerSound, SoundThatIsLongerThanThePicturePlaysToItsEnd) {
  bench_.sources["film"] = PlayerBench::film(25);
  bench_.sources["film"].tracks.push_back(PlayerBench::soundTrack(75));
  playsWell();
  EXPECT_EQ(moments_.size(), 25u);
  EXPECT_NEAR(bench_.report.media_s, 3.0, 0.1);
  EXPECT_EQ(bench_.report.sound.underruns, 0u);
  EXPECT_THAT(bench_.report.faults, IsEmpty());
}

// Ten minutes on a card whose crystal is off by 200 ppm: unled, that is 120 ms.
class PlayerSoundDrift : public PlayerSound, public testing::WithParamInterface<double> {};
INSTANTIATE_TEST_SUITE_P(Ppm, PlayerSoundDrift, testing::Values(200.0, -200.0),
                         [](const auto& test) { return test.param > 0 ? "Fast" : "Slow"; });

TEST_P(PlayerSoundDrift, StaysWithin20MsOfEveryPictureForTenMinutes) {
  bench_.audio->drift_ppm = GetParam();
  film(15'000);
  playsWell();
  ASSERT_EQ(moments_.size(), 15'000u);
  EXPECT_LT(worstOffsetMs(1, moments_.size()), 20.0);
  EXPECT_EQ(bench_.report.sound.realigned, 0u) << "led, not started anew";
  EXPECT_LT(bench_.report.sound.max_offset_ms, 20.0);
  EXPECT_NEAR(bench_.report.sound.drift_ppm, GetParam(), 20);
  // The film has gone at the sound's pace.
  EXPECT_NEAR(toSeconds(fromSeconds(moments_.back().time_s - moments_[1].time_s)) * (1 + 1e-6 * GetParam()),
              14'998 * 0.04, 0.01);
}

TEST_P(PlayerSoundDrift, StaysThereThoughPositionsAreRoughAndSoundIsLateByItself) {
  bench_.audio->drift_ppm = GetParam();
  bench_.audio->jitter = 5ms;
  bench_.audio->start_latency = 150ms;  // as of a wireless one
  film(3000);
  playsWell();
  EXPECT_EQ(bench_.report.sound.realigned, 1u) << "once, when its latency is known";
  EXPECT_LT(worstOffsetMs(25, moments_.size()), 20.0) << "from one second on";
}

// Each picture is there just after a refresh and waits for the next one.
TEST_F(PlayerSound, WaitsForAScreenThatIsSlow) {
  film(500);
  bench_.display.refresh_period = PlayerBench::kPeriod / 2;
  playsWell();
  // The clock starts with the first picture; every later picture is late by one refresh.
  const double late_s = moments_[0].time_s + 0.02;
  std::erase_if(moments_, [late_s](const Moment& moment) {  // what is drawn anew between two
    return std::abs(std::remainder(moment.time_s - late_s, 0.04)) > 0.01;
  });
  ASSERT_GE(moments_.size(), 490u);
  for (std::size_t k = 25; k < moments_.size(); ++k) {
    const double picture_s = moments_[k].time_s - late_s;
    EXPECT_NEAR(moments_[k].heard_s.value_or(0), picture_s, k < 250 ? 0.01 : 0.003) << k;
  }
}

TEST_F(PlayerSound, APauseIsSilentAtOnceAndSoundGoesOnWhereThePictureDoes) {
  film(500);
  bench_.audio->start_latency = 40ms;
  bench_.press(5.02, KEY_PAUSE);
  bench_.press(8.02, KEY_PLAY);
  playsWell();
  // The same picture again, with other words on it.
  for (const Moment& moment : takeMoments(5.02, 8.035)) EXPECT_FALSE(moment.heard_s) << moment.time_s;
  ASSERT_EQ(moments_.size(), 500u);
  EXPECT_LT(worstOffsetMs(25, 125), 10.0);
  // The latency is known by then: the second start is right, but that nothing is heard while it lasts.
  EXPECT_LT(worstOffsetMs(129, 500), 10.0);
  EXPECT_EQ(bench_.report.sound.realigned, 1u);
  EXPECT_EQ(bench_.report.sound.underruns, 0u);
}

TEST_F(PlayerSound, AfterASeekItIsThatOfTheNewPlace) {
  film(1000);
  bench_.sources["film"].tracks[0].keyframe_interval = 12;
  bench_.press(5.02, KEY_FORWARD);
  bench_.press(8.0, KEY_STOP);
  playsWell();
  ASSERT_EQ(bench_.report.seeks.size(), 1u);
  const double picture_s = bench_.report.seeks[0].picture_s.value_or(0);
  ASSERT_GT(picture_s, 14.9);
  std::vector<Moment> after = takeMoments(5.02, 8.0);
  ASSERT_GT(after.size(), 70u);
  EXPECT_FALSE(after[0].heard_s) << "nothing of the old place";
  for (std::size_t k = 1; k < after.size(); ++k) {
    EXPECT_NEAR(after[k].heard_s.value_or(0), picture_s + 0.04 * static_cast<double>(k), 0.001) << k;
  }
}

TEST_F(PlayerSound, ALoopBeginsAnewWithItsSound) {
  film(50);
  bench_.config.loop = true;
  bench_.config.duration = 5s;
  playsWell();
  ASSERT_GT(moments_.size(), 110u);
  for (std::size_t k = 0; k < moments_.size(); ++k) {
    if (k % 50 == 0) {
      EXPECT_FALSE(moments_[k].heard_s) << k;
    } else {
      EXPECT_NEAR(moments_[k].heard_s.value_or(0), 0.04 * static_cast<double>(k % 50), 0.001) << k;
    }
  }
  EXPECT_EQ(bench_.report.sound.underruns, 0u);
}

// As in many a transport stream and MP4: the reader has to go further for it than for the pictures.
TEST_F(PlayerSound, LiesLateInTheFilmAndIsThereFromTheFirstPictureOn) {
  film(500);
  sound().late = 1200ms;
  playsWell();
  EXPECT_LT(worstOffsetMs(1, 500), 1.0);
  EXPECT_EQ(bench_.report.sound.underruns, 0u);
}

// Further than anybody looks for it: the pictures do not wait, and it is heard where it can.
TEST_F(PlayerSound, TooLateInTheFilmToBeHeardDoesNotHoldThePictures) {
  film(500);
  sound().late = 60s;
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 500u);
  EXPECT_NEAR(bench_.report.wall_s, 20.0, 0.02);
}

TEST_F(PlayerSound, MayBeginLaterThanThePictureAndEndEarlier) {
  film(250);
  sound().first_pts = 2s;
  sound().frames = 150;  // to 5 s
  playsWell();
  for (std::size_t k = 1; k < 250; ++k) {
    const double picture_s = 0.04 * static_cast<double>(k);
    if (picture_s > 2.001 && picture_s < 4.98) {
      EXPECT_NEAR(offsetMs(k), 0, 1.0) << k;
    } else if (picture_s < 1.99 || picture_s > 5.01) {
      EXPECT_EQ(moments_[k].heard_s.value_or(0), 0.0) << k;
    }
  }
  EXPECT_EQ(bench_.report.sound.underruns, 0u) << "a silence of the film's own";
  EXPECT_NEAR(bench_.report.wall_s, 10.0, 0.02);
}

// With its own threads, on the machine's clock: no figure of time is asserted.
TEST_F(PlayerSound, AFilmThatComesTooSlowlyIsSilentAndGoesOnWithItsSound) {
  film(60);
  bench_.sources["film"].stall_after_packets = 120;
  bench_.sources["film"].stall = 900ms;
  bench_.display.shown = nullptr;
  bench_.config.own_threads = true;
  MonotonicClock time;
  ASSERT_TRUE(bench_.runOn(time));
  EXPECT_THAT(bench_.states(), testing::HasSubstr("playing buffering playing"));
  EXPECT_GT(bench_.report.sound.pictures, 10u);
  EXPECT_EQ(bench_.faults("sound"), 0u);
}

TEST_F(PlayerSound, InSlowMotionThereIsNoneAndAtItsOwnPaceItIsBackInPlace) {
  film(250);
  bench_.press(2.02, KEY_SLOW);
  bench_.press(4.02, KEY_PLAY);
  playsWell();
  const std::vector<Moment> slow = takeMoments(2.03, 4.1);
  ASSERT_GT(slow.size(), 20u);
  for (const Moment& moment : slow) {
    if (moment.time_s < 4.02) {
      EXPECT_FALSE(moment.heard_s) << moment.time_s;
    }
  }
  EXPECT_LT(worstOffsetMs(1, 50), 1.0);
  const Moment& last = moments_.back();  // of picture 249
  for (std::size_t k = 52; k < moments_.size(); ++k) {
    const double picture_s = 249 * 0.04 - (last.time_s - moments_[k].time_s);
    EXPECT_NEAR(moments_[k].heard_s.value_or(0), picture_s, 0.001) << k;
  }
}

TEST_F(PlayerSound, OfACardThatGoesAwayTheFilmGoesOnAndItIsTakenUpAgain) {
  film(500);
  bench_.display.shown = [this, inner = bench_.display.shown] {
    const double now_s = toSeconds(bench_.clock.now().time_since_epoch());
    bench_.ear->unplugged = now_s > 4 && now_s < 6;
    inner();
  };
  bench_.audio->drift_ppm = 200;
  playsWell();
  ASSERT_EQ(moments_.size(), 500u);
  EXPECT_LT(worstOffsetMs(1, 99), 20.0);
  EXPECT_FALSE(moments_[120].heard_s);
  EXPECT_LT(worstOffsetMs(260, 499), 20.0);
  EXPECT_EQ(bench_.faults("sound: the mock sound card has gone away"), 1u);
  EXPECT_EQ(bench_.faults("sound output back"), 1u);
  for (std::size_t k = 2; k < 500; ++k) {  // no picture was late or early
    EXPECT_NEAR(moments_[k].time_s - moments_[k - 1].time_s, 0.04, 0.002) << k;
  }
}

TEST_F(PlayerSound, OfACardThatIsRefusedTheFilmPlaysWithoutAndSaysSoOnce) {
  film(500);
  bench_.audio->fail_open = ErrorCode::Exhausted;
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 500u);
  EXPECT_EQ(bench_.report.faults.size(), 1u);
  EXPECT_EQ(bench_.faults("sound: the mock sound card was told not to open"), 1u);
  EXPECT_EQ(silentMoments(), 500u);
}

TEST_F(PlayerSound, AFilmWithoutSoundIsNotSaidToHaveAnOutput) {
  bench_.sources["film"] = PlayerBench::film(25);
  playsWell();
  EXPECT_EQ(bench_.report.sound.device, "");
  film(25);
  playsWell();
  EXPECT_EQ(bench_.report.sound.device, "null");
}

TEST_F(PlayerSound, WhoHasNothingToHearIsNotToldOfTheCard) {
  bench_.audio->fail_open = ErrorCode::Exhausted;
  playsWell();  // a film without sound
  EXPECT_THAT(bench_.report.faults, IsEmpty());
}

// Some outputs take whatever comes and say that it was heard.
TEST_F(PlayerSound, AnOutputThatKeepsNoTimeDoesNotLeadTheFilm) {
  film(500);
  bench_.audio->paced = false;
  playsWell();
  EXPECT_EQ(bench_.faults("the sound output reports no position"), 1u);
  EXPECT_NEAR(bench_.report.wall_s, 20.0, 0.1);
}

TEST_F(PlayerSound, DamagedPacketsAreSilenceAndNothingMoves) {
  film(500);
  bench_.sources["film"].damaged_every = 101;  // of any track
  const auto played = bench_.run();
  ASSERT_TRUE(played);
  std::size_t wrong = 0;
  for (const Moment& moment : moments_) {
    const double off_s = moment.heard_s.value_or(0) - (moment.time_s - moments_[1].time_s + 0.04);
    if (std::abs(off_s) > 0.002) ++wrong;
  }
  EXPECT_LT(wrong, 25u);
}

}  // namespace
}  // namespace relievo
