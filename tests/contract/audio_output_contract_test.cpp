// SPDX-License-Identifier: Apache-2.0
// Every sound output under the contract, and what is special to ALSA.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "drivers/alsa/alsa.h"
#include "drivers/mock/mock.h"
#include "drivers/sample/sample.h"
#include "tests/contract/suite/audio_output.h"
#include "tests/support/machine/fake_sound_card.h"

namespace relievo {
namespace {

using Output = test::AudioOutputRig;
using namespace std::chrono_literals;

Output makeFakeCard(ManualClock& clock, snd_pcm_format_t format = SND_PCM_FORMAT_FLOAT) {
  static const bool plugged = (test::plugFakeSoundCard(), true);
  EXPECT_TRUE(plugged);
  test::fakeSoundCard() = {.clock = &clock, .format = format};
  return {makeAlsaOutput("fake", clock), [](bool unplugged) { test::fakeSoundCard().unplugged = unplugged; }};
}

const test::AudioOutputBackend kBackends[] = {
    {"null",
     [](ManualClock& clock) {
       const auto bench = std::make_shared<MockAudioBench>();
       return Output{makeMockAudio({}, clock, bench), [bench](bool unplugged) { bench->unplugged = unplugged; }};
     }},
    {"alsa_float", [](ManualClock& clock) { return makeFakeCard(clock); }},
    {"alsa_16_bit", [](ManualClock& clock) { return makeFakeCard(clock, SND_PCM_FORMAT_S16); }},
    {"sample",
     [](ManualClock& clock) {
       const auto card = std::make_shared<SampleCard>();
       return Output{makeSampleAudio(card, clock), [card](bool unplugged) { card->there = !unplugged; }};
     }},
};

INSTANTIATE_TEST_SUITE_P(Backends, AudioOutputContract, testing::ValuesIn(kBackends), test::kBackendName);

TEST(AlsaOutput, SaysWhatToDoAboutACardThatIsNotThere) {
  ManualClock clock;
  static_cast<void>(makeFakeCard(clock));
  const auto opened = makeAlsaOutput("no such card", clock)->open({});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::NotFound);
}

// True once the server has given back the thread that waited for it.
bool opensAgain(AudioOutput& audio, const AudioFormat& wished = {}) {
  for (int tries = 0; tries < 1000; ++tries) {
    if (audio.open(wished)) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

TEST(AlsaOutput, AWriteThatDoesNotReturnLosesTheCardUntilTheServerAnswers) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock);
  ASSERT_TRUE(audio->open({}));
  test::sound_server_stalls = true;
  const auto written = audio->write(std::vector<float>(960));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::Lost);
  EXPECT_EQ(audio->state(), AudioOutput::State::Lost);
  audio->close();
  EXPECT_EQ(audio->open({}).error().code, ErrorCode::Timeout);
  EXPECT_EQ(audio->open({}).error().code, ErrorCode::Timeout);
  test::sound_server_stalls = false;
  EXPECT_TRUE(opensAgain(*audio));
  EXPECT_TRUE(audio->write(std::vector<float>(960)));
}

TEST(AlsaOutput, ACloseThatDoesNotReturnIsForgottenOnceTheServerAnswers) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock);
  ASSERT_TRUE(audio->open({}));
  test::sound_server_stalls = true;
  audio->close();
  EXPECT_EQ(audio->open({}).error().code, ErrorCode::Timeout);
  test::sound_server_stalls = false;
  EXPECT_TRUE(opensAgain(*audio));
}

TEST(AlsaOutput, GivesUpASoundServerThatDoesNotAnswerAndFindsItAgain) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock);
  test::sound_server_stalls = true;
  for (int tries = 0; tries < 2; ++tries) {
    const auto opened = audio->open({});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::Timeout);
  }
  test::sound_server_stalls = false;
  EXPECT_TRUE(opensAgain(*audio));
}

// Closing waits for the server, as opening does.
TEST(AlsaOutput, NeverClosesACardOnThePlayersThread) {
  ManualClock clock;
  {
    const auto [audio, unplug] = makeFakeCard(clock, SND_PCM_FORMAT_U8);
    EXPECT_EQ(audio->open({}).error().code, ErrorCode::Unsupported);
    EXPECT_NE(test::fakeSoundCard().closed_by, std::thread::id()) << "it was opened";
    EXPECT_NE(test::fakeSoundCard().closed_by, std::this_thread::get_id());
  }
  const auto [audio, unplug] = makeFakeCard(clock);
  test::sound_server_stalls = true;
  EXPECT_EQ(audio->open({.rate_hz = 44100}).error().code, ErrorCode::Timeout);
  test::sound_server_stalls = false;
  EXPECT_TRUE(opensAgain(*audio, {.rate_hz = 32000}));
  EXPECT_NE(test::fakeSoundCard().closed_by, std::thread::id()) << "the late card of 44.1 kHz";
  EXPECT_NE(test::fakeSoundCard().closed_by, std::this_thread::get_id());
}

TEST(AlsaOutput, WritesSixteenBitsWithoutWrappingRound) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock, SND_PCM_FORMAT_S16);
  ASSERT_TRUE(audio->open({}));
  const std::vector<float> loud{0.5F, -0.5F, 1.5F, -1.5F};
  ASSERT_TRUE(audio->write(loud));
  EXPECT_EQ(test::fakeSoundCard().loudest, 32767);
}

// ALSA's own null device takes everything at once.
TEST(AlsaOutput, OpensTheLibrarysOwnDevices) {
  ManualClock clock;
  static_cast<void>(makeFakeCard(clock));
  const auto audio = makeAlsaOutput("null", clock);
  const auto opened = audio->open({});
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(audio->write(std::vector<float>(960)));
  EXPECT_TRUE(audio->position());
  EXPECT_TRUE(audio->flush());
}

}  // namespace
}  // namespace relievo
