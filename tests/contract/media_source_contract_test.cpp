// SPDX-License-Identifier: Apache-2.0
// The contract of every media source: states, one final end, packets that outlive it, seeking to key frames.
#include <algorithm>
#include <cstring>
#include <filesystem>

#include "drivers/pictures/pictures.h"
#include "tests/contract/films.h"
#include "tests/contract/state_table.h"
#ifdef RELIEVO_ROSBAG
#include "drivers/rosbag/rosbag.h"
#include "tests/contract/bag_film.h"
#endif

namespace relievo {
namespace {

using State = MediaSource::State;
using namespace std::chrono_literals;

Result<StreamInfo> describePicture(const std::string& path) {
  const auto source = makeFfmpegSource();
  if (auto opened = source->open(path); !opened) return std::unexpected(opened.error());
  return source->streams().at(0);
}

// A folder of pictures, each of which is a key frame.
std::string folderOfPictures() {
  static const test::TemporaryFolder folder;
  static const std::string path = [] {
    std::filesystem::create_directory(folder / "film");
    test::makeClip(folder / "film/%02d.png",
                   {{.codec = "png", .pix_fmt = "gray", .fps_num = 25, .frames = test::kFilmFrames}});
    return folder / "film";
  }();
  return path;
}
const test::FilmBackend kPictures{"pictures",
                                  [] { return makePicturesSource(describePicture); },
                                  makeFfmpegDecoder,
                                  folderOfPictures,
                                  "/nonexistent/%d.png",
                                  test::kFilmPeriod};

class MediaSourceContract : public test::FilmContract {};
const auto kNameOf = [](const auto& test) { return std::string(test.param.name); };
INSTANTIATE_TEST_SUITE_P(Backends, MediaSourceContract, testing::ValuesIn(test::kFilmBackends), kNameOf);
INSTANTIATE_TEST_SUITE_P(Pictures, MediaSourceContract, testing::Values(kPictures), kNameOf);
#ifdef RELIEVO_ROSBAG
INSTANTIATE_TEST_SUITE_P(Bags, MediaSourceContract,
                         testing::Values(test::FilmBackend{"rosbag", makeRosbagSource, makeFfmpegDecoder, test::bagFilm,
                                                           "/nonexistent/film.bag", test::kFilmPeriod, false}),
                         kNameOf);
#endif

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

// ---- the guard itself
// ------------------------------------------------------------------------------------------------

// Ends at once; a second read would begin again.
class Relapsing final : public MediaSource {
  Result<Description> openSource(const std::string&) override { return Description{}; }
  Result<std::optional<Packet>> readPacket() override {
    if (reads_++ == 0) return std::nullopt;
    return Packet{};
  }
  Result<void> seekTo(MediaTime) override { return {}; }
  void closeSource() noexcept override {}
  void interrupted() noexcept override {}
  int reads_ = 0;
};

TEST(MediaSourceGuard, AsksNoMoreAfterTheEnd) {
  Relapsing source;
  ASSERT_TRUE(source.open(""));
  EXPECT_FALSE(source.read().value());
  EXPECT_FALSE(source.read().value());
}

// ---- tests that need the fault switches of a mock
// ------------------------------------------------------------------

// Two tracks: 30 pictures every 40 ms, and 15 every 80 ms that begin 10 ms later.
MockMediaProfile twoTracks() {
  MockTrack color, depth;
  color.frames = 30, color.frame_period = 40ms;
  depth.frames = 15, depth.frame_period = 80ms, depth.first_pts = 10ms;
  return {.tracks = {color, depth}};
}

struct MockFilm {
  explicit MockFilm(MockMediaProfile profile) : source(makeMockSource(std::move(profile), clock)) {}
  // Reads to the end; returns the number of packets and how it ended.
  std::pair<std::size_t, test::Answer> readThrough() {
    for (std::size_t count = 0;; ++count) {
      const auto packet = source->read();
      if (!packet || !*packet) return {count, test::answerOf(packet)};
    }
  }
  ManualClock clock;
  std::unique_ptr<MediaSource> source;
};

TEST(MockSource, InterleavesItsTracksByTime) {
  MockFilm film(twoTracks());
  ASSERT_TRUE(film.source->open(""));
  std::vector<std::pair<int, Duration>> first;
  for (int i = 0; i < 5; ++i) {
    const auto packet = film.source->read().value().value();
    first.emplace_back(packet.stream, packet.pts->time_since_epoch());
  }
  const std::vector<std::pair<int, Duration>> expected = {{0, 0ms}, {1, 10ms}, {0, 40ms}, {0, 80ms}, {1, 90ms}};
  EXPECT_EQ(first, expected);
}

TEST(MockSource, GoesAwayForGoodAfterSoManyPackets) {
  MockMediaProfile profile = twoTracks();
  profile.lose_after_packets = 7;
  MockFilm film(profile);
  ASSERT_TRUE(film.source->open(""));
  EXPECT_EQ(film.readThrough(), std::pair(std::size_t{7}, test::Answer(ErrorCode::Lost)));
  EXPECT_EQ(test::answerOf(film.source->read()), ErrorCode::Lost);
  EXPECT_EQ(test::answerOf(film.source->seek(MediaTime(0ms))), ErrorCode::Lost);
  film.source->close();
  ASSERT_TRUE(film.source->open(""));
  EXPECT_TRUE(film.source->read());
}

TEST(MockSource, ACutOffFilmEndsLikeAWholeOne) {
  MockMediaProfile profile = twoTracks();
  profile.end_after_packets = 7;
  MockFilm film(profile);
  ASSERT_TRUE(film.source->open(""));
  EXPECT_EQ(film.readThrough(), std::pair(std::size_t{7}, test::Answer()));
  EXPECT_EQ(film.source->state(), State::Ended);
}

TEST(MockSource, StallsOnceOnItsClock) {
  MockMediaProfile profile = twoTracks();
  profile.stall_after_packets = 2;
  profile.stall = 3s;
  MockFilm film(profile);
  ASSERT_TRUE(film.source->open(""));
  EXPECT_TRUE(film.source->read() && film.source->read());
  EXPECT_EQ(film.clock.now(), MonotonicTime(0s));
  EXPECT_TRUE(film.source->read());
  EXPECT_EQ(film.clock.now(), MonotonicTime(3s));
  EXPECT_TRUE(film.source->read());
  EXPECT_EQ(film.clock.now(), MonotonicTime(3s));
}

TEST(MockSource, LosesTheFramesThatItShall) {
  MockTrack track;
  track.frames = 6;
  track.missing = {0, 3, 5};
  MockFilm film({.tracks = {track}});
  ASSERT_TRUE(film.source->open(""));
  for (const int frame : {1, 2, 4}) EXPECT_EQ(film.source->read().value()->pts, track.pts(frame));
  EXPECT_FALSE(film.source->read().value());
}

TEST(MockSource, ALiveFilmHasNoDurationAndCannotSeek) {
  MockMediaProfile profile = twoTracks();
  profile.live = true;
  MockFilm film(profile);
  ASSERT_TRUE(film.source->open(""));
  EXPECT_EQ(film.source->duration(), Duration(0));
  EXPECT_EQ(test::answerOf(film.source->seek(MediaTime(0ms))), ErrorCode::Unsupported);
  EXPECT_TRUE(film.source->read());
}

TEST(MockSource, AFailedOpeningLeavesItClosed) {
  MockFilm film({.fail_open = ErrorCode::Timeout});
  EXPECT_EQ(test::answerOf(film.source->open("")), ErrorCode::Timeout);
  EXPECT_EQ(film.source->state(), State::Closed);
}

}  // namespace
}  // namespace relievo
