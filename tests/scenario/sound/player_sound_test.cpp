// SPDX-License-Identifier: Apache-2.0
// Films with sound in simulated time: each picture is compared with the sample that is heard when it is shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <cmath>
#include <vector>

#include "tests/scenario/player_bench.h"
#include "tests/scenario/sound/player_sound.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;
using testing::IsEmpty;

class DeafDecoder final : public AudioDecoder {
 public:
  [[nodiscard]] const char* name() const noexcept override { return "deaf"; }

 private:
  Result<void> openDecoder(const StreamInfo&, const AudioFormat&) override {
    return fail(ErrorCode::Unsupported, "it is deaf");
  }
  Result<AudioChunk> decodePacket(const Packet&) override { return AudioChunk{}; }
  void flushDecoder() noexcept override {}
  void closeDecoder() noexcept override {}
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
  EXPECT_EQ(bench_.report.film.sound, std::optional<std::size_t>(1)) << "that of the report too";
}

TEST_F(PlayerSound, ATrackThatCannotBeDecodedIsToldWhenItIsChosen) {
  bench_.config.keys = KeyTable::parse("[always]\nA = \"audio\"\n", "keys").value();
  film(150);
  bench_.sources["film"].tracks.push_back(PlayerBench::soundTrack(150));
  bench_.make_audio_decoder = [made = 0]() mutable -> std::unique_ptr<AudioDecoder> {
    if (++made == 2) return std::make_unique<DeafDecoder>();
    return makeMockAudioDecoder();
  };
  bench_.press(2.0, KEY_A);
  bench_.press(4.0, KEY_A);
  playsWell();
  ASSERT_EQ(bench_.report.faults.size(), 1u);
  EXPECT_EQ(bench_.report.faults[0].what, "sound 2 of 2: it is deaf");
  EXPECT_NEAR(bench_.report.faults[0].time_s, 2.0, 0.1);
  EXPECT_EQ(bench_.report.faults[0].count, 1u) << "not for the first track again";
  EXPECT_TRUE(moments_[moments_.size() - 5].heard_s) << "the first track again";
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

// The last picture stands, whether the film is sought to there or goes on there after a pause.
TEST_F(PlayerSound, ItGoesOnBehindTheLastPicture) {
  bench_.sources["film"] = PlayerBench::film(25);
  bench_.sources["film"].tracks.push_back(PlayerBench::soundTrack(500));
  bench_.press(0.5, KEY_FORWARD);
  bench_.press(2.5, KEY_PAUSE);
  bench_.press(5.5, KEY_PLAY);
  bench_.config.osd = true;
  bench_.press(6.5, KEY_VOLUMEUP);  // so that something is shown, and the sound then looked at
  playsWell();
  ASSERT_EQ(bench_.report.seeks.size(), 1u);
  EXPECT_NEAR(bench_.report.seeks[0].target_s, 10.5, 0.05);
  EXPECT_NEAR(bench_.report.seeks[0].picture_s.value_or(0), 0.96, 1e-6);
  EXPECT_NEAR(bench_.report.wall_s, 13.0, 0.1) << "half a second, ten, and a pause of three";
  const std::vector<Moment> late = takeMoments(6.5, 6.6);
  ASSERT_FALSE(late.empty());
  EXPECT_NEAR(late[0].heard_s.value_or(0), 13.5, 0.05);
}

// Ten minutes on a card whose crystal is off by 200 ppm: without correction, the sound would be 120 ms off at the end.
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
  std::erase_if(moments_, [late_s](const Moment& moment) {  // drops the redraws between two pictures
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
  // The latency is known by then, so that the second start is in time. While the output starts, nothing is heard.
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

}  // namespace
}  // namespace relievo::test
