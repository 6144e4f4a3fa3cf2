// SPDX-License-Identifier: Apache-2.0
// The cases of the media source's contract.
#include "tests/contract/suite/media_source.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "tests/contract/state_table.h"

namespace relievo {

using namespace std::chrono_literals;

bool test::mediaSourceCases() {
  return true;
}
// Without this line a program fails that the linker gives this file only for an inline function of the standard
// library.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(MediaSourceContract);

TEST_P(MediaSourceContract, EveryVerbInEveryState) {
  const std::string url = GetParam().url();
  const std::vector<test::Verb<MediaSource>> verbs = {
      {"open", [&](MediaSource& s) { return test::answerOf(s.open(url)); }},
      {"read", [](MediaSource& s) { return test::answerOf(s.read()); }},
      {"seek", [](MediaSource& s) { return test::answerOf(s.seek(MediaTime(500ms))); }},
      {"close", [](MediaSource& s) { return s.close(), test::Answer{}; }},
  };
  constexpr auto no = std::nullopt;
  const std::vector<test::Row<State>> table = {
      // from            open         read         seek         close
      {State::Closed, {State::Open, no, no, State::Closed}},
      {State::Open, {no, State::Open, State::Open, State::Closed}},
      {State::Ended, {no, State::Ended, State::Open, State::Closed}},
  };
  test::expectStateTable(verbs, table, [&](State state) {
    auto source = GetParam().make_source();
    EXPECT_TRUE(state == State::Closed || source->open(url));
    if (state == State::Ended) (void)readAll(*source);
    return source;
  });
}

TEST_P(MediaSourceContract, DescribesTheFilmWhileOpenAndOnlyThen) {
  const auto source = GetParam().make_source();
  EXPECT_TRUE(source->streams().empty());
  EXPECT_TRUE(source->tags().empty());
  EXPECT_EQ(source->duration(), Duration(0));
  ASSERT_TRUE(source->open(GetParam().url()));
  const auto expectFilm = [&] {
    ASSERT_EQ(source->streams().size(), 1u);
    const StreamInfo& stream = source->streams()[0];
    EXPECT_EQ(stream.index, 0);
    EXPECT_EQ(stream.kind, StreamKind::Video);
    EXPECT_EQ(stream.width, 64);
    EXPECT_EQ(stream.height, 48);
    EXPECT_EQ(stream.frame_period, test::kFilmPeriod);
    if (GetParam().titled) {
      EXPECT_EQ(source->tags().at("TITLE"), "film") << "keys are in upper case";
    }
    EXPECT_NEAR(toSeconds(source->duration()), test::kFilmFrames * 0.04, 0.041);
  };
  expectFilm();
  (void)readAll(*source);
  expectFilm();
  source->close();
  EXPECT_TRUE(source->streams().empty());
  EXPECT_TRUE(source->tags().empty());
  EXPECT_EQ(source->duration(), Duration(0));
}

TEST_P(MediaSourceContract, HandsOutEveryPictureFromTimeZero) {
  const auto packets = readAll(*openSource());
  ASSERT_EQ(packets.size(), static_cast<std::size_t>(test::kFilmFrames));
  std::vector<MediaTime> times;
  for (const Packet& packet : packets) {
    EXPECT_EQ(packet.stream, 0);
    EXPECT_NE(packet.data, nullptr);
    EXPECT_GT(packet.bytes, 0u);
    ASSERT_TRUE(packet.pts);
    times.push_back(*packet.pts);
  }
  EXPECT_TRUE(packets[0].keyframe);
  std::sort(times.begin(), times.end());
  for (int i = 0; i < test::kFilmFrames; ++i) EXPECT_EQ(times[static_cast<std::size_t>(i)], MediaTime(i * 40ms)) << i;
}

TEST_P(MediaSourceContract, TheEndComesOnceAndStays) {
  const auto source = openSource();
  (void)readAll(*source);
  for (int i = 0; i < 3; ++i) {
    const auto packet = source->read();
    ASSERT_TRUE(packet);
    EXPECT_FALSE(*packet);
    EXPECT_EQ(source->state(), State::Ended);
  }
}

TEST_P(MediaSourceContract, OfAWholeFilmNothingIsMissing) {
  const auto source = openSource();
  EXPECT_EQ(source->missing(), Duration(0));
  (void)readAll(*source);
  EXPECT_EQ(source->missing(), Duration(0));
  ASSERT_TRUE(source->seek(MediaTime(1h)));
  (void)readAll(*source);
  EXPECT_EQ(source->missing(), Duration(0));
}

TEST_P(MediaSourceContract, PacketsOutliveTheSource) {
  auto source = openSource();
  const auto packet = source->read();
  ASSERT_TRUE(packet && *packet);
  const std::vector<std::uint8_t> bytes((*packet)->data, (*packet)->data + (*packet)->bytes);
  (void)readAll(*source);
  source->close();
  source.reset();
  EXPECT_EQ(std::memcmp(bytes.data(), (*packet)->data, bytes.size()), 0);
}

TEST_P(MediaSourceContract, SeeksToTheKeyFrameAtOrBeforeTheTarget) {
  const auto source = openSource();
  for (const Duration at : {500ms, 400ms, 399ms, 0ms, -1000ms, 1100ms}) {
    const MediaTime target(at);
    const MediaTime key(std::max(Duration(0), at / GetParam().key_step * GetParam().key_step));
    SCOPED_TRACE(toSeconds(target));
    ASSERT_TRUE(source->seek(MediaTime(target)));
    const auto packet = source->read();
    ASSERT_TRUE(packet && *packet);
    EXPECT_TRUE((*packet)->keyframe);
    EXPECT_EQ((*packet)->pts, MediaTime(key));
  }
}

TEST_P(MediaSourceContract, PlaysAgainAfterASeekFromTheEnd) {
  const auto source = openSource();
  (void)readAll(*source);
  ASSERT_TRUE(source->seek(MediaTime(0ms)));
  EXPECT_EQ(source->state(), State::Open);
  EXPECT_EQ(readAll(*source).size(), static_cast<std::size_t>(test::kFilmFrames));
  EXPECT_EQ(source->state(), State::Ended);
}

TEST_P(MediaSourceContract, AnInterruptionHoldsUntilTheNextOpening) {
  const auto source = openSource();
  ASSERT_TRUE(source->read());
  source->interrupt();
  EXPECT_EQ(test::answerOf(source->read()), ErrorCode::Cancelled);
  EXPECT_EQ(test::answerOf(source->seek(MediaTime(0ms))), ErrorCode::Cancelled);
  EXPECT_EQ(test::answerOf(source->read()), ErrorCode::Cancelled);
  EXPECT_EQ(source->state(), State::Open) << "an interruption is not an end";
  source->close();
  source->interrupt();  // while nothing waits
  ASSERT_TRUE(source->open(GetParam().url()));
  EXPECT_EQ(readAll(*source).size(), static_cast<std::size_t>(test::kFilmFrames));
}

TEST_P(MediaSourceContract, AFailedOpeningLeavesItClosedAndUsable) {
  if (GetParam().missing_url == nullptr) GTEST_SKIP() << "every url is a film to this back end";
  const auto source = GetParam().make_source();
  EXPECT_EQ(test::answerOf(source->open(GetParam().missing_url)), ErrorCode::NotFound);
  EXPECT_EQ(source->state(), State::Closed);
  EXPECT_TRUE(source->streams().empty());
  EXPECT_TRUE(source->open(GetParam().url()));
}

}  // namespace relievo
