// SPDX-License-Identifier: Apache-2.0
// Every media source under the contract; the guard itself; tests that need the fault switches of a mock.
#include <filesystem>

#include "drivers/pictures/pictures.h"
#include "tests/contract/films.h"
#include "tests/contract/state_table.h"
#include "tests/contract/suite/media_source.h"
#ifdef RELIEVO_OPENNI
#include "drivers/openni/openni.h"
#include "tests/contract/oni_film.h"
#endif
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
                                  [] {
                                    auto source = makePicturesSource(describePicture);
                                    source->setPictureRate(25);
                                    return source;
                                  },
                                  makeFfmpegDecoder,
                                  folderOfPictures,
                                  "/nonexistent/%d.png",
                                  test::kFilmPeriod};

INSTANTIATE_TEST_SUITE_P(Backends, MediaSourceContract, testing::ValuesIn(test::kFilmBackends), test::kBackendName);
INSTANTIATE_TEST_SUITE_P(Pictures, MediaSourceContract, testing::Values(kPictures), test::kBackendName);
#ifdef RELIEVO_OPENNI
INSTANTIATE_TEST_SUITE_P(OpenniRecordings, MediaSourceContract,
                         testing::Values(test::FilmBackend{"openni", makeOpenniSource, makeFfmpegDecoder, test::oniFilm,
                                                           "/nonexistent/film.oni", test::kFilmPeriod, false}),
                         test::kBackendName);
#endif
#ifdef RELIEVO_ROSBAG
INSTANTIATE_TEST_SUITE_P(Bags, MediaSourceContract,
                         testing::Values(test::FilmBackend{"rosbag", makeRosbagSource, makeFfmpegDecoder, test::bagFilm,
                                                           "/nonexistent/film.bag", test::kFilmPeriod, false}),
                         test::kBackendName);
#endif

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
