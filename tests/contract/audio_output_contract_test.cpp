// SPDX-License-Identifier: Apache-2.0
// The contract of every sound output: states, whole frames, room, and positions that advance at its rate.
#include <gtest/gtest.h>

#include <vector>

#include "drivers/alsa/alsa.h"
#include "drivers/mock/mock.h"
#include "drivers/sample/sample.h"
#include "tests/contract/state_table.h"
#include "tests/support/machine/fake_sound_card.h"

namespace relievo {
namespace {

using State = AudioOutput::State;
using namespace std::chrono_literals;

struct Output {
  std::unique_ptr<AudioOutput> audio;
  std::function<void(bool)> unplug;
};

struct Backend {
  const char* name;
  std::function<Output(ManualClock&)> make;
};
void PrintTo(const Backend& backend, std::ostream* out) {
  *out << backend.name;
}

Output makeFakeCard(ManualClock& clock, bool takes_float) {
  static const bool plugged = (test::plugFakeSoundCard(), true);
  EXPECT_TRUE(plugged);
  test::fakeSoundCard() = {.clock = &clock, .takes_float = takes_float};
  return {makeAlsaOutput("fake", clock), [](bool unplugged) { test::fakeSoundCard().unplugged = unplugged; }};
}

const Backend kBackends[] = {
    {"null",
     [](ManualClock& clock) {
       const auto bench = std::make_shared<MockAudioBench>();
       return Output{makeMockAudio({}, clock, bench), [bench](bool unplugged) { bench->unplugged = unplugged; }};
     }},
    {"alsa_float", [](ManualClock& clock) { return makeFakeCard(clock, true); }},
    {"alsa_16_bit", [](ManualClock& clock) { return makeFakeCard(clock, false); }},
    {"sample",
     [](ManualClock& clock) {
       const auto card = std::make_shared<SampleCard>();
       return Output{makeSampleAudio(card, clock), [card](bool unplugged) { card->there = !unplugged; }};
     }},
};

class AudioOutputContract : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override { output_ = GetParam().make(clock_); }
  [[nodiscard]] AudioOutput& audio() const { return *output_.audio; }
  // Writes sound of that length and returns how many frames were taken.
  std::int64_t write(Duration length) {
    const AudioFormat& format = audio().format();
    const auto frames = static_cast<std::size_t>(toSeconds(length) * format.rate_hz);
    const std::vector<float> samples(frames * static_cast<std::size_t>(format.channels), 0.25F);
    const auto taken = audio().write(samples);
    EXPECT_TRUE(taken) << taken.error().message;
    return static_cast<std::int64_t>(taken.value_or(0));
  }
  [[nodiscard]] std::optional<AudioPosition> position() const {
    const auto at = audio().position();
    EXPECT_TRUE(at) << at.error().message;
    return at.value_or(std::nullopt);
  }

  ManualClock clock_{MonotonicTime(1h)};
  Output output_;
};
INSTANTIATE_TEST_SUITE_P(Backends, AudioOutputContract, testing::ValuesIn(kBackends),
                         [](const auto& test) { return std::string(test.param.name); });

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

TEST(AlsaOutput, SaysWhatToDoAboutACardThatIsNotThere) {
  ManualClock clock;
  static_cast<void>(makeFakeCard(clock, true));
  const auto opened = makeAlsaOutput("no such card", clock)->open({});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::NotFound);
}

TEST(AlsaOutput, WritesSixteenBitsWithoutWrappingRound) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock, false);
  ASSERT_TRUE(audio->open({}));
  const std::vector<float> loud{0.5F, -0.5F, 1.5F, -1.5F};
  ASSERT_TRUE(audio->write(loud));
  EXPECT_EQ(test::fakeSoundCard().loudest, 32767);
}

// ALSA's own null device takes everything at once.
TEST(AlsaOutput, OpensTheLibrarysOwnDevices) {
  ManualClock clock;
  static_cast<void>(makeFakeCard(clock, true));
  const auto audio = makeAlsaOutput("null", clock);
  const auto opened = audio->open({});
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(audio->write(std::vector<float>(960)));
  EXPECT_TRUE(audio->position());
  EXPECT_TRUE(audio->flush());
}

}  // namespace
}  // namespace relievo
