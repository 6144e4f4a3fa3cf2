// SPDX-License-Identifier: Apache-2.0
// Films whose sound is late, lost, damaged or absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "tests/scenario/sound/player_sound.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;
using testing::IsEmpty;

// The container stores the sound later than its pictures, as many transport streams and MP4 files do, so that the
// reader has to read further for it.
TEST_F(PlayerSound, LiesLateInTheFilmAndIsThereFromTheFirstPictureOn) {
  film(500);
  sound().late = 1200ms;
  playsWell();
  EXPECT_LT(worstOffsetMs(1, 500), 1.0);
  EXPECT_EQ(bench_.report.sound.underruns, 0u);
}

// The sound lies further away than the reader looks for it. The pictures must not wait for it.
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

// Hands everything on to a card, which the test chooses when it is opened.
class HandsOn : public AudioOutput {
 public:
  HandsOn(Clock& clock, std::shared_ptr<MockAudioBench> ear) : clock_(clock), ear_(std::move(ear)) {}
  [[nodiscard]] Capabilities capabilities() const noexcept override { return {.name = "hands on"}; }

 protected:
  Result<AudioFormat> openCard(int rate_hz, const AudioFormat& wished) {
    card_.reset();  // before the next one is at the ear
    card_ = makeMockAudio({.format = AudioFormat{.rate_hz = rate_hz}}, clock_, ear_);
    return card_->open(wished);
  }

  Clock& clock_;

 private:
  Result<std::size_t> writeFrames(const float* samples, std::size_t frames) override {
    return card_->write({samples, frames * static_cast<std::size_t>(card_->format().channels)});
  }
  Result<std::optional<AudioPosition>> samplePosition() override { return card_->position(); }
  Result<void> dropFrames() override { return card_->flush(); }
  void closeOutput() noexcept override {
    if (card_) card_->close();
  }

  std::shared_ptr<MockAudioBench> ear_;
  std::unique_ptr<AudioOutput> card_;
};

// Is exchanged for one of another rate when it is opened again.
class ExchangedCard final : public HandsOn {
 public:
  using HandsOn::HandsOn;

 private:
  Result<AudioFormat> openOutput(const AudioFormat& wished) override {
    return openCard(opens_++ == 0 ? 48'000 : 44'100, wished);
  }
  int opens_ = 0;
};

TEST_F(PlayerSound, ACardOfAnotherRateIsHeardFromTheNextFilmOn) {
  film(250);
  bench_.sources["./one"] = bench_.sources["./two"] = bench_.sources["film"];
  bench_.texts["list.m3u"] = "one\ntwo\n";
  bench_.config.source.url = "list.m3u";
  bench_.make_output = [this](Clock& clock) { return std::make_unique<ExchangedCard>(clock, bench_.ear); };
  bench_.display.shown = [this, inner = bench_.display.shown] {
    const double now_s = toSeconds(bench_.clock.now().time_since_epoch());
    bench_.ear->unplugged = now_s > 1 && now_s < 2;
    inner();
  };
  playsWell();
  ASSERT_EQ(moments_.size(), 500u);
  EXPECT_FALSE(moments_[240].heard_s);
  EXPECT_NEAR(moments_[300].heard_s.value_or(-1), 2.0, 0.02) << "50 pictures into the second film";
  EXPECT_EQ(bench_.faults("another rate or number of channels"), 1u);
  EXPECT_EQ(bench_.report.sound.rate_hz, 44'100);
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

// A sound server that answers from a time on.
class LateServer final : public HandsOn {
 public:
  LateServer(Clock& clock, std::shared_ptr<MockAudioBench> ear, Duration wait, int rate_hz = 48'000)
      : HandsOn(clock, std::move(ear)), answers_(clock.now() + wait), rate_hz_(rate_hz) {}

 private:
  Result<AudioFormat> openOutput(const AudioFormat& wished) override {
    if (clock_.now() < answers_) return fail(ErrorCode::Timeout, "the server does not answer");
    return openCard(rate_hz_, wished);
  }
  MonotonicTime answers_;
  int rate_hz_;
};

TEST_F(PlayerSound, OfAServerThatAnswersLateIsHeardAsSoonAsItDoes) {
  for (const auto& [answers, faults] : {std::pair<Duration, unsigned>(1500ms, 0), {3700ms, 1}}) {
    SCOPED_TRACE(toSeconds(answers));
    moments_.clear();
    film(500);
    bench_.make_output = [this, wait = answers](Clock& clock) {
      return std::make_unique<LateServer>(clock, bench_.ear, wait);
    };
    playsWell();
    EXPECT_EQ(bench_.faults("sound: the server does not answer"), faults);
    EXPECT_EQ(bench_.report.faults.size(), faults);
    ASSERT_EQ(moments_.size(), 500u);
    EXPECT_FALSE(moments_[25].heard_s);
    EXPECT_EQ(moments_[50].heard_s.has_value(), faults == 0) << "2 s";
    EXPECT_TRUE(moments_[225].heard_s) << "9 s";
  }
}

// Its rate is not known before: the film is decoded for it from there on.
TEST_F(PlayerSound, OfAServerThatAnswersLateWithAnotherRateIsHeardInTheFirstFilm) {
  for (const Duration wait : {700ms, 1500ms, 3700ms}) {
    SCOPED_TRACE(toSeconds(wait));
    moments_.clear();
    film(500);
    bench_.make_output = [this, wait](Clock& clock) {
      return std::make_unique<LateServer>(clock, bench_.ear, wait, 44'100);
    };
    const auto played = bench_.run();
    ASSERT_TRUE(played) << played.error().error.message;
    EXPECT_EQ(bench_.faults("another rate"), 0u);
    EXPECT_EQ(bench_.report.sound.rate_hz, 44'100);
    ASSERT_GE(moments_.size(), 500u);
    EXPECT_FALSE(moments_[15].heard_s);
    const double picture_s = 499 * 0.04 - (moments_.back().time_s - moments_[300].time_s);
    EXPECT_NEAR(moments_[300].heard_s.value_or(-1), picture_s, 0.02);
  }
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

// Some outputs accept all samples at once and report that they were played.
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
  ASSERT_FALSE(played) << "it was not whole";
  std::size_t wrong = 0;
  for (const Moment& moment : moments_) {
    const double off_s = moment.heard_s.value_or(0) - (moment.time_s - moments_[1].time_s + 0.04);
    if (std::abs(off_s) > 0.002) ++wrong;
  }
  EXPECT_LT(wrong, 25u);
}

}  // namespace
}  // namespace relievo::test
