// SPDX-License-Identifier: Apache-2.0
// The cases of the sound output's contract.
#include "tests/contract/suite/audio_output.h"

#include <utility>
#include <vector>

#include "tests/contract/state_table.h"

namespace relievo {

using namespace std::chrono_literals;

bool test::audioOutputCases() {
  return true;
}
// Without this line a program fails that the linker gives this file only for an inline function of the standard
// library.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AudioOutputContract);

std::int64_t AudioOutputContract::write(Duration length) {
  const AudioFormat& format = audio().format();
  const auto frames = static_cast<std::size_t>(toSeconds(length) * format.rate_hz);
  const std::vector<float> samples(frames * static_cast<std::size_t>(format.channels), 0.25F);
  const auto taken = audio().write(samples);
  EXPECT_TRUE(taken) << taken.error().message;
  return static_cast<std::int64_t>(taken.value_or(0));
}

std::optional<AudioPosition> AudioOutputContract::position() const {
  const auto at = audio().position();
  EXPECT_TRUE(at) << at.error().message;
  return at.value_or(std::nullopt);
}

TEST_P(AudioOutputContract, EveryVerbInEveryState) {
  const std::vector<float> frame(2);
  const std::vector<test::Verb<AudioOutput>> verbs = {
      {"open", [](AudioOutput& a) { return test::answerOf(a.open({})); }},
      {"write", [&](AudioOutput& a) { return test::answerOf(a.write(frame)); }},
      {"position", [](AudioOutput& a) { return test::answerOf(a.position()); }},
      {"flush", [](AudioOutput& a) { return test::answerOf(a.flush()); }},
      {"close", [](AudioOutput& a) { return a.close(), test::Answer{}; }},
  };
  constexpr auto no = std::nullopt;
  const std::vector<test::Row<State>> table = {
      // from            open         write        position     flush        close
      {State::Closed, {State::Open, no, no, no, State::Closed}},
      {State::Open, {no, State::Open, State::Open, State::Open, State::Closed}},
      {State::Lost, {no, no, no, no, State::Closed}},
  };
  test::expectStateTable(verbs, table, [&](State state) {
    auto [audio, unplug] = GetParam().make(clock_);
    EXPECT_TRUE(state == State::Closed || audio->open({}));
    if (state == State::Lost) {
      EXPECT_TRUE(audio->write(frame));
      unplug(true);
      EXPECT_EQ(test::answerOf(audio->write(frame)), ErrorCode::Lost);
    }
    return std::move(audio);
  });
}

TEST_P(AudioOutputContract, TakesNoMoreThanItsBufferHolds) {
  ASSERT_TRUE(audio().open({}));
  const double room = toSeconds(audio().capabilities().buffer) * audio().format().rate_hz;
  EXPECT_GE(audio().capabilities().buffer, 400ms) << "longer than a picture takes to draw";
  EXPECT_NEAR(static_cast<double>(write(3s)), room, 1);
  EXPECT_EQ(write(1s), 0);
  clock_.advance(100ms);
  EXPECT_NEAR(static_cast<double>(write(1s)), 0.1 * audio().format().rate_hz, 2);
}

TEST_P(AudioOutputContract, PositionsRunAtItsRateFromTheFirstFrameOn) {
  ASSERT_TRUE(audio().open({.rate_hz = 44100, .channels = 2}));
  EXPECT_EQ(audio().format(), (AudioFormat{44100, 2}));
  EXPECT_FALSE(position());
  write(400ms);
  for (int reading = 0; reading < 4; ++reading) {
    const auto at = position();
    ASSERT_TRUE(at);
    EXPECT_EQ(at->time, clock_.now());
    EXPECT_NEAR(static_cast<double>(at->frames), toSeconds(at->time - MonotonicTime(1h)) * 44100, 1);
    clock_.advance(100ms);
  }
}

TEST_P(AudioOutputContract, RunsDryIsSilentAndGoesOnWithTheNextFrame) {
  ASSERT_TRUE(audio().open({}));
  const std::int64_t before = write(200ms);
  clock_.advance(1s);
  EXPECT_FALSE(position());
  write(200ms);
  clock_.advance(50ms);
  const auto at = position();
  ASSERT_TRUE(at);
  EXPECT_NEAR(static_cast<double>(at->frames - before), 2400, 1);
}

TEST_P(AudioOutputContract, AFlushIsSilentAndCountsAnew) {
  ASSERT_TRUE(audio().open({}));
  write(400ms);
  clock_.advance(100ms);
  ASSERT_TRUE(audio().flush());
  EXPECT_FALSE(position());
  clock_.advance(1s);
  EXPECT_FALSE(position());
  EXPECT_NEAR(static_cast<double>(write(3s)), toSeconds(audio().capabilities().buffer) * 48000, 1);
  clock_.advance(100ms);
  ASSERT_TRUE(position());
  EXPECT_NEAR(static_cast<double>(position()->frames), 4800, 1);
}

TEST_P(AudioOutputContract, LostWhenItIsPulledOutAndBackWhenItIsThereAgain) {
  ASSERT_TRUE(audio().open({}));
  write(400ms);
  output_.unplug(true);
  const auto at = audio().position();
  EXPECT_TRUE(!at || !*at);
  if (audio().state() == State::Open) {
    EXPECT_EQ(test::answerOf(audio().write(std::vector<float>(2))), ErrorCode::Lost);
  }
  EXPECT_EQ(audio().state(), State::Lost);
  audio().close();
  EXPECT_EQ(test::answerOf(audio().open({})), ErrorCode::NotFound);
  EXPECT_EQ(audio().state(), State::Closed);
  output_.unplug(false);
  ASSERT_TRUE(audio().open({}));
  EXPECT_GT(write(100ms), 0);
}

TEST_P(AudioOutputContract, RefusesWhatIsNoFormatAndNoWholeFrames) {
  EXPECT_EQ(test::answerOf(audio().open({.rate_hz = 0})), ErrorCode::InvalidArgument);
  EXPECT_EQ(test::answerOf(audio().open({.channels = 0})), ErrorCode::InvalidArgument);
  ASSERT_TRUE(audio().open({}));
  const std::vector<float> odd(3);
  EXPECT_EQ(test::answerOf(audio().write(odd)), ErrorCode::InvalidArgument);
  EXPECT_EQ(audio().write({}), std::size_t{0});
}

}  // namespace relievo
