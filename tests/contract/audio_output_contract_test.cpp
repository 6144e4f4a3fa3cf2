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
#include "tests/support/machine/no_threads.h"

namespace relievo {
namespace {

using Output = test::AudioOutputRig;
using namespace std::chrono_literals;

// A busy machine may take long to run a helper thread.
constexpr AlsaPatience kLong{.open = 20s, .call = 20s};

Output makeFakeCard(ManualClock& clock, snd_pcm_format_t format = SND_PCM_FORMAT_FLOAT, AlsaPatience patience = kLong) {
  static const bool plugged = (test::plugFakeSoundCard(), true);
  EXPECT_TRUE(plugged);
  test::fakeSoundCard() = {.clock = &clock, .format = format};
  return {makeAlsaOutput("fake", clock, patience), [](bool unplugged) { test::fakeSoundCard().unplugged = unplugged; }};
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
  const auto opened = makeAlsaOutput("no such card", clock, kLong)->open({});
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

// Opened in any case.
constexpr AlsaPatience kBrief{.open = 20s, .call = 1ms};

// Until it takes some: a busy machine may not have run the helper thread.
std::size_t takenInTheEnd(AudioOutput& audio, const std::vector<float>& samples) {
  for (int tries = 0; tries < 1000; ++tries) {
    if (const auto taken = audio.write(samples); !taken || *taken > 0) return taken.value_or(0);
    std::this_thread::sleep_for(10ms);
  }
  return 0;
}

TEST(AlsaOutput, AWriteThatDoesNotReturnLosesTheCardAfter3SAndHoldsNobody) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock, SND_PCM_FORMAT_FLOAT, kBrief);
  ASSERT_TRUE(audio->open({}));
  test::sound_server_stalls = true;
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(audio->write(std::vector<float>(960)), std::size_t{0});
    EXPECT_TRUE(audio->position());
    clock.advance(100ms);
  }
  const auto written = audio->write(std::vector<float>(960));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::Lost);
  EXPECT_EQ(audio->state(), AudioOutput::State::Lost);
  audio->close();
  EXPECT_EQ(audio->open({}).error().code, ErrorCode::Timeout);
  EXPECT_EQ(audio->open({}).error().code, ErrorCode::Timeout);
  test::sound_server_stalls = false;
  EXPECT_TRUE(opensAgain(*audio));
  EXPECT_EQ(takenInTheEnd(*audio, std::vector<float>(960)), 480);
}

TEST(AlsaOutput, AWriteThatReturnsLateCountsOnce) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock, SND_PCM_FORMAT_FLOAT, kBrief);
  ASSERT_TRUE(audio->open({}));
  test::sound_server_stalls = true;
  const std::vector<float> some(960);
  EXPECT_EQ(audio->write(some), std::size_t{0});
  test::sound_server_stalls = false;
  EXPECT_EQ(takenInTheEnd(*audio, some), 480);
  const auto room = static_cast<std::size_t>(toSeconds(audio->capabilities().buffer) * 48000);
  EXPECT_EQ(takenInTheEnd(*audio, std::vector<float>(96'000)), room - 480);
}

TEST(AlsaOutput, WhatAWriteThatReturnsLateHasWrittenIsDroppedByAFlush) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock, SND_PCM_FORMAT_FLOAT, kBrief);
  ASSERT_TRUE(audio->open({}));
  test::sound_server_stalls = true;
  EXPECT_EQ(audio->write(std::vector<float>(960)), std::size_t{0});
  EXPECT_TRUE(audio->flush());
  test::sound_server_stalls = false;
  const auto room = static_cast<std::size_t>(toSeconds(audio->capabilities().buffer) * 48000);
  EXPECT_EQ(takenInTheEnd(*audio, std::vector<float>(96'000)), room);
}

TEST(AlsaOutput, ACloseThatDoesNotReturnIsForgottenOnceTheServerAnswers) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock, SND_PCM_FORMAT_FLOAT, kBrief);
  ASSERT_TRUE(audio->open({}));
  test::sound_server_stalls = true;
  audio->close();
  EXPECT_EQ(audio->open({}).error().code, ErrorCode::Timeout);
  test::sound_server_stalls = false;
  EXPECT_TRUE(opensAgain(*audio));
}

TEST(AlsaOutput, ASoundServerThatDoesNotAnswerHoldsNobodyAndIsFoundAgain) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock, SND_PCM_FORMAT_FLOAT, {.open = 1ms, .call = 1ms});
  test::sound_server_stalls = true;
  for (int tries = 0; tries < 2; ++tries) {
    const auto opened = audio->open({});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::Timeout);
  }
  test::sound_server_stalls = false;
  EXPECT_TRUE(opensAgain(*audio));
}

TEST(AlsaOutput, AMachineWithoutAnotherThreadIsNotTakenForASilentServer) {
  ManualClock clock;
  const auto [audio, unplug] = makeFakeCard(clock, SND_PCM_FORMAT_FLOAT, {.open = 1ms, .call = 1ms});
  {
    const test::NoThreads limit;
    for (int tries = 0; tries < 2; ++tries) {
      const auto opened = audio->open({});
      ASSERT_FALSE(opened);
      EXPECT_EQ(opened.error().code, ErrorCode::Timeout) << "it is tried again";
      EXPECT_STREQ(opened.error().message, "the limit on processes is reached; raise it (ulimit -u) or end some");
    }
  }
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
  const auto [audio, unplug] = makeFakeCard(clock, SND_PCM_FORMAT_FLOAT, {.open = 1ms, .call = 20s});
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
  const auto audio = makeAlsaOutput("null", clock, kLong);
  const auto opened = audio->open({});
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(audio->write(std::vector<float>(960)));
  EXPECT_TRUE(audio->position());
  EXPECT_TRUE(audio->flush());
}

}  // namespace
}  // namespace relievo
