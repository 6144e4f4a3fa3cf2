// SPDX-License-Identifier: Apache-2.0
// The cases of the sound decoder's contract.
#include "tests/contract/suite/audio_decoder.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "tests/contract/state_table.h"

namespace relievo {

bool test::audioDecoderCases() {
  return true;
}
// Without this line a program fails that the linker gives this file only for an inline function of the standard
// library.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AudioDecoderContract);

TEST_P(AudioDecoderContract, EveryVerbInEveryState) {
  const Packet packet = nextPacket().value();
  const std::vector<test::Verb<AudioDecoder>> verbs = {
      {"open", [this](AudioDecoder& d) { return test::answerOf(d.open(stream(), {})); }},
      {"decode", [&](AudioDecoder& d) { return test::answerOf(d.decode(packet)); }},
      {"flush", [](AudioDecoder& d) { return test::answerOf(d.flush()); }},
      {"close", [](AudioDecoder& d) { return d.close(), test::Answer{}; }},
  };
  constexpr auto no = std::nullopt;
  const std::vector<test::Row<State>> table = {
      // from            open         decode       flush        close
      {State::Closed, {State::Open, no, no, State::Closed}},
      {State::Open, {no, State::Open, State::Open, State::Closed}},
  };
  test::expectStateTable(verbs, table, [&](State state) {
    auto decoder = GetParam().make();
    EXPECT_TRUE(state == State::Closed || decoder->open(stream(), {}));
    return decoder;
  });
}

TEST_P(AudioDecoderContract, RefusesAStreamOfPictures) {
  EXPECT_EQ(test::answerOf(decoder_->open(source_->streams().front(), {})), ErrorCode::InvalidArgument);
}

TEST_P(AudioDecoderContract, GivesTheWholeSoundAtItsTimesWithoutASeam) {
  ASSERT_TRUE(decoder_->open(stream(), {}));
  const auto chunks = decodeAll();
  ASSERT_GT(chunks.size(), 5u);
  EXPECT_EQ(decoder_->damaged(), 0u);
  std::int64_t frame = 0;
  for (const AudioChunk& chunk : chunks) {
    ASSERT_EQ(chunk.samples.size() % 2, 0u);
    EXPECT_NEAR(toSeconds(chunk.pts), static_cast<double>(frame) / 48000, 0.001);
    for (std::size_t i = 0; i < chunk.samples.size(); ++i) {
      const double seconds = static_cast<double>(frame + static_cast<std::int64_t>(i / 2)) / 48000;
      ASSERT_NEAR(chunk.samples[i], 0.5 * std::sin(2 * std::numbers::pi * 440 * seconds), 1e-3) << seconds;
    }
    frame += static_cast<std::int64_t>(chunk.samples.size() / 2);
  }
  EXPECT_EQ(frame, 48000);
}

TEST_P(AudioDecoderContract, GivesTheFormatThatIsAskedFor) {
  ASSERT_TRUE(decoder_->open(stream(), {.rate_hz = 32000, .channels = 1}));
  std::size_t samples = 0;
  for (const AudioChunk& chunk : decodeAll()) samples += chunk.samples.size();
  EXPECT_NEAR(static_cast<double>(samples), 32000, 50);
}

TEST_P(AudioDecoderContract, GoesOnAfterASeek) {
  ASSERT_TRUE(decoder_->open(stream(), {}));
  static_cast<void>(decodeAll());
  ASSERT_TRUE(source_->seek(MediaTime{}));
  ASSERT_TRUE(decoder_->flush());
  const auto again = decodeAll();
  ASSERT_FALSE(again.empty());
  EXPECT_EQ(again.front().pts, MediaTime{});
}

TEST_P(AudioDecoderContract, ADamagedPacketIsCountedAndNoError) {
  ASSERT_TRUE(decoder_->open(stream(), {}));
  const Packet good = nextPacket().value();
  std::uint8_t noise[500];
  for (std::size_t i = 0; i < sizeof noise; ++i) noise[i] = static_cast<std::uint8_t>(37 * i + 11);
  const auto nothing = decoder_->decode({.stream = good.stream, .data = noise, .bytes = sizeof noise});
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(nothing->samples.empty());
  EXPECT_EQ(decoder_->damaged(), 1u);
  EXPECT_FALSE(decoder_->decode(good)->samples.empty());
}

}  // namespace relievo
