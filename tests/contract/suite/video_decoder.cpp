// SPDX-License-Identifier: Apache-2.0
// The cases of the video decoder's contract.
#include "tests/contract/suite/video_decoder.h"

#include <algorithm>
#include <cstdlib>

#include "tests/contract/state_table.h"

namespace relievo {

bool test::videoDecoderCases() {
  return true;
}
// Without this line a program fails that the linker gives this file only for an inline function of the standard
// library.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(VideoDecoderContract);

TEST_P(VideoDecoderContract, EveryVerbInEveryState) {
  const std::vector<test::Verb<VideoDecoder>> verbs = {
      {"open", [&](VideoDecoder& d) { return test::answerOf(d.open(stream_)); }},
      {"feed", [&](VideoDecoder& d) { return test::answerOf(d.feed(packets_[0])); }},
      {"receive", [](VideoDecoder& d) { return test::answerOf(d.receive()); }},
      {"drain", [](VideoDecoder& d) { return test::answerOf(d.drain()); }},
      {"flush", [](VideoDecoder& d) { return test::answerOf(d.flush()); }},
      {"close", [](VideoDecoder& d) { return d.close(), test::Answer{}; }},
      {"leaveOutUnreferenced", [](VideoDecoder& d) { return test::answerOf(d.leaveOutUnreferenced(false)); }},
  };
  constexpr auto no = std::nullopt;
  const std::vector<test::Row<State>> table = {
      // from              open         feed         receive          drain            flush        close  leave out
      {State::Closed, {State::Open, no, no, no, no, State::Closed, no}},
      {State::Open, {no, State::Open, State::Open, State::Draining, State::Open, State::Closed, State::Open}},
      {State::Draining, {no, no, State::Draining, no, State::Open, State::Closed, State::Draining}},
      {State::Ended, {no, no, State::Ended, no, State::Open, State::Closed, State::Ended}},
  };
  test::expectStateTable(verbs, table, [&](State state) { return bring(state); });
}

TEST_P(VideoDecoderContract, EveryPictureComesOutOnceInOrderOfPresentation) {
  EXPECT_EQ(timesOf(*openDecoder()), filmTimes());
}

TEST_P(VideoDecoderContract, PicturesAreAsTheStreamSays) {
  const auto decoder = openDecoder();
  play(*decoder, packets(), packets(test::kFilmFrames), [](const Frame& frame) {
    EXPECT_FALSE(frame.empty());
    EXPECT_EQ(frame.width, 64);
    EXPECT_EQ(frame.height, 48);
    EXPECT_EQ(frame.duration, test::kFilmPeriod);
    EXPECT_NE(frame.owner, nullptr);
    EXPECT_GE(std::abs(frame.planes[0].stride_bytes), 64);
  });
}

TEST_P(VideoDecoderContract, WhenFullItTakesNothingAndTheSamePacketLater) {
  const auto decoder = openDecoder();
  int next = 0;
  while (next < test::kFilmFrames &&
         decoder->feed(packets_[static_cast<std::size_t>(next)]).value() == Feed::Accepted) {
    ++next;
  }
  ASSERT_LT(next, test::kFilmFrames) << "it never becomes full";
  for (int i = 0; i < 3; ++i) EXPECT_EQ(decoder->feed(*packets(next)).value(), Feed::Full);
  EXPECT_EQ(packets(next)->owner.use_count(), 1) << "the refused packet is the caller's alone";
  std::vector<MediaTime> times;
  for (const Frame& frame : receiveAll(*decoder)) times.push_back(frame.pts);
  EXPECT_FALSE(times.empty()) << "full, but nothing to receive";
  EXPECT_EQ(decoder->feed(*packets(next)).value(), Feed::Accepted);
  for (const Frame& frame : receiveAll(*decoder)) times.push_back(frame.pts);
  for (const MediaTime time : timesOf(*decoder, next + 1)) times.push_back(time);
  EXPECT_EQ(times, filmTimes()) << "nothing was lost, nothing came twice";
}

TEST_P(VideoDecoderContract, TheEndComesOnceAndStays) {
  const auto decoder = bring(State::Ended);
  for (int i = 0; i < 3; ++i) {
    const auto frame = decoder->receive();
    ASSERT_TRUE(frame);
    EXPECT_FALSE(*frame);
    EXPECT_EQ(decoder->state(), State::Ended);
  }
}

TEST_P(VideoDecoderContract, DrainingAnEmptyDecoderEndsAtOnce) {
  const auto decoder = openDecoder();
  ASSERT_TRUE(decoder->drain());
  EXPECT_FALSE(decoder->receive().value());
  EXPECT_EQ(decoder->state(), State::Ended);
}

TEST_P(VideoDecoderContract, AFlushForgetsWhatIsInside) {
  const auto decoder = openDecoder();
  play(*decoder, packets(), packets(5), [](const Frame&) {});
  ASSERT_TRUE(decoder->flush());
  EXPECT_EQ(timesOf(*decoder, 2 * test::kFilmKeyInterval), filmTimes(2 * test::kFilmKeyInterval))
      << "as after a seek: no picture from before, all from after";
  ASSERT_TRUE(decoder->flush());
  EXPECT_EQ(timesOf(*decoder), filmTimes()) << "from the end likewise";
}

TEST_P(VideoDecoderContract, PicturesStayAsTheyAreWhileHeldAndOutliveTheDecoder) {
  auto decoder = openDecoder();
  std::vector<Frame> held;
  std::vector<std::uint64_t> digests;
  const auto hold = [&](Frame frame) {
    if (held.size() >= static_cast<std::size_t>(std::min(decoder->capabilities().max_held_frames, 8)) - 1) return;
    digests.push_back(digest(frame));
    held.push_back(std::move(frame));
  };
  play(*decoder, packets(), packets(test::kFilmFrames), hold);
  ASSERT_GT(held.size(), 3u);
  decoder->close();
  decoder.reset();
  source_.reset();
  for (std::size_t i = 0; i < held.size(); ++i) EXPECT_EQ(digest(held[i]), digests[i]) << i;
  EXPECT_NE(digests.front(), digests.back()) << "the film moves";
}

TEST_P(VideoDecoderContract, ADamagedPacketIsDroppedAndCounted) {
  const auto decoder = openDecoder();
  static const std::uint8_t noise[] = {0, 0, 0, 1, 0xFF, 0x13, 0x37};
  Packet damaged = packets_[3];
  damaged.data = noise;
  damaged.bytes = sizeof noise;
  damaged.owner = std::make_shared<int>(0);
  std::swap(packets_[3], damaged);
  EXPECT_EQ(decoder->damaged(), 0u);
  const std::size_t pictures = timesOf(*decoder).size();
  EXPECT_GT(decoder->damaged(), 0u);
  EXPECT_LT(pictures, static_cast<std::size_t>(test::kFilmFrames));
  // Pictures that depend on the lost one are lost with it, but none beyond the next key frame.
  EXPECT_GE(pictures, static_cast<std::size_t>(test::kFilmFrames - test::kFilmKeyInterval));
  decoder->close();
  ASSERT_TRUE(decoder->open(stream_));
  EXPECT_EQ(decoder->damaged(), 0u) << "counted since opening";
}

TEST_P(VideoDecoderContract, CapabilitiesStayTheSame) {
  const auto decoder = openDecoder();
  const auto first = decoder->capabilities();
  EXPECT_STRNE(first.name, "");
  EXPECT_GT(first.max_held_frames, 2);
  (void)timesOf(*decoder);
  EXPECT_STREQ(decoder->capabilities().name, first.name);
  EXPECT_EQ(decoder->capabilities().max_held_frames, first.max_held_frames);
  EXPECT_EQ(decoder->capabilities().hardware, first.hardware);
}

TEST_P(VideoDecoderContract, RefusesWhatItCannotDecodeAndStaysClosed) {
  const auto decoder = GetParam().make_decoder();
  StreamInfo audio = stream_;
  audio.kind = StreamKind::Audio;
  EXPECT_EQ(test::answerOf(decoder->open(audio)), ErrorCode::InvalidArgument);
  StreamInfo unknown;
  unknown.kind = StreamKind::Video;
  unknown.codec = "no-such-codec";
  EXPECT_EQ(test::answerOf(decoder->open(unknown)), ErrorCode::Unsupported);
  StreamInfo huge = stream_;
  huge.width = 4097, huge.height = 4096;
  EXPECT_EQ(test::answerOf(decoder->open(huge)), ErrorCode::Unsupported);
  EXPECT_EQ(decoder->state(), State::Closed);
  EXPECT_TRUE(decoder->open(stream_)) << "and works again as before";
}

}  // namespace relievo
