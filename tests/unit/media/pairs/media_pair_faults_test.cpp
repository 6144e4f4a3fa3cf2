// SPDX-License-Identifier: Apache-2.0
// Paired films that are cut, damaged, lost or interrupted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/mock/mock.h"
#include "tests/support/film/clip_maker.h"
#include "tests/unit/media/pairs/pairs_read.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;

std::string failureOf(const SourceOptions& options, std::string& thing) {
  PairReader reader(kFfmpeg);
  const auto opened = reader.open(options);
  EXPECT_FALSE(opened.has_value());
  thing = reader.failedThing();
  return opened ? "" : opened.error().message;
}

TEST(PairReader, SaysWhichThingFailedAndWhy) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {color(30, 3)});
  const std::string film = folder / "a.mkv";
  const std::string none = folder / "none.mkv";
  std::string thing;
  EXPECT_THAT(failureOf({.url = none}, thing), testing::HasSubstr("no such file"));
  EXPECT_EQ(thing, none);
  EXPECT_THAT(failureOf({.url = film, .depth_url = none}, thing), testing::HasSubstr("no such file"));
  EXPECT_EQ(thing, none);
  EXPECT_THAT(failureOf({.url = film, .packing = Packing::Tracks}, thing), testing::HasSubstr("only one video track"));
  EXPECT_EQ(thing, film);
  EXPECT_THAT(failureOf({.url = film, .depth_url = film, .packing = Packing::TopBottom}, thing),
              testing::HasSubstr("cannot be packed"));
  EXPECT_THAT(failureOf({.url = film, .depth_url = film, .command_line = {{"near", "9"}, {"far", "1"}}}, thing),
              testing::HasSubstr("far"));
  EXPECT_EQ(thing, "calibration");
}

TEST(PairReader, ACutFilmPlaysWhatIsThere) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {color(30, 60), depth(30, 60)});
  std::filesystem::resize_file(folder / "a.mkv", std::filesystem::file_size(folder / "a.mkv") / 2);
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  const auto pairs = readAll(reader);
  EXPECT_GT(pairs.size(), 10u);
  EXPECT_LT(pairs.size(), 60u);
  for (std::size_t k = 0; k + 2 < pairs.size(); ++k) {
    EXPECT_EQ(numberOf(pairs[k].color), static_cast<int>(k));
    EXPECT_EQ(numberOf(pairs[k].depth), static_cast<int>(k));
  }
}

TEST(PairReader, AFilmWithoutOnePictureDoesNotOpen) {
  MockFilm film;
  film.color.damaged_every = 1;
  const auto opened = film.reader.open({.url = "color"});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::Corrupt);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("not one picture"));
  EXPECT_EQ(film.reader.failedThing(), "color");
}

TEST(PairReader, DepthAskedForByNameHasToBeThere) {
  MockFilm film;
  film.depth.damaged_every = 1;
  const auto opened = film.reader.open({.url = "color", .depth_url = "depth"});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::Corrupt);
  EXPECT_EQ(film.reader.failedThing(), "depth");
}

// Two tracks of one film, the second without a picture: the film plays flat, with a warning.
TEST(PairReader, DepthThatIsFoundAndCannotBeReadIsGivenUp) {
  MockFilm film;
  film.color.tracks = {MockTrack{.frames = 5}, MockTrack{.frames = 0}};
  testing::internal::CaptureStderr();
  ASSERT_TRUE(film.reader.open({.url = "film"}).has_value());
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("film: no depth from here on"));
  EXPECT_FALSE(film.reader.info().has_depth);
  int pairs = 0;
  while (const auto pair = film.reader.next().value()) {
    EXPECT_TRUE(pair->depth.empty());
    ++pairs;
  }
  EXPECT_EQ(pairs, 5);
}

TEST(PairReader, LostDepthEndsTheDepthAndNotTheFilm) {
  MockFilm film;
  film.color.tracks[0].frames = film.depth.tracks[0].frames = 30;
  film.depth.lose_after_packets = 10;
  ASSERT_TRUE(film.reader.open({.url = "color", .depth_url = "depth"}).has_value());
  testing::internal::CaptureStderr();
  int with_depth = 0, pairs = 0;
  while (const auto pair = film.reader.next().value()) {
    ++pairs;
    EXPECT_TRUE(pair->matched);
    if (!pair->depth.empty()) ++with_depth;
  }
  ASSERT_TRUE(film.reader.seek(MediaTime{}).has_value());  // does not bring the depth back
  EXPECT_TRUE(film.reader.next().value()->depth.empty());
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(pairs, 30);
  EXPECT_GE(with_depth, 8);
  EXPECT_LE(with_depth, 10);
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_THAT(said, testing::HasSubstr("depth: no depth from here on"));
}

// A source that fails one read and then works again, like a network connection.
class OnceFailingSource final : public MediaSource {
 public:
  OnceFailingSource(std::unique_ptr<MediaSource> source, int good_reads, ErrorCode code)
      : source_(std::move(source)), reads_left_(good_reads), code_(code) {}

 private:
  Result<Description> openSource(const std::string& url) override {
    if (auto opened = source_->open(url); !opened) return std::unexpected(opened.error());
    return Description{source_->streams(), source_->tags(), source_->duration()};
  }
  Result<std::optional<Packet>> readPacket() override {
    if (reads_left_-- == 0) return fail(code_, "the network has gone");
    return source_->read();
  }
  Result<void> seekTo(MediaTime target) override { return source_->seek(target); }
  void closeSource() noexcept override { source_->close(); }
  void interrupted() noexcept override { source_->interrupt(); }
  std::unique_ptr<MediaSource> source_;
  int reads_left_;
  ErrorCode code_;
};

// The eleventh read of the depth's source fails.
PairReader::Backends onceFailingDepth(Clock& clock, ErrorCode code) {
  return {[&clock, code, sources = 0](const std::string&) mutable -> std::unique_ptr<MediaSource> {
            auto source = makeMockSource({}, clock);
            if (sources++ == 0) return source;
            return std::make_unique<OnceFailingSource>(std::move(source), 10, code);
          },
          [](const StreamInfo&) { return makeMockDecoder(); }};
}

TEST(PairReader, AnInterruptionIsNoLossOfDepth) {
  ManualClock clock;
  PairReader reader(onceFailingDepth(clock, ErrorCode::Cancelled));
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  for (int k = 0; k < 9; ++k) ASSERT_TRUE(reader.next().has_value());
  const auto pair = reader.next();
  ASSERT_FALSE(pair.has_value());
  EXPECT_EQ(pair.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(reader.failedThing(), "depth");
  EXPECT_FALSE(reader.next().value()->depth.empty());
}

TEST(PairReader, ASeekFindsLostDepthAgain) {
  ManualClock clock;
  PairReader reader(onceFailingDepth(clock, ErrorCode::Lost));
  testing::internal::CaptureStderr();
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  for (int k = 0; k < 20; ++k) ASSERT_EQ(reader.next().value()->depth.empty(), k >= 9) << k;  // one is read ahead
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("the network has gone"));
  ASSERT_TRUE(reader.seek(mediaTime(0.5)).has_value());
  for (int k = 0; k < 20; ++k) {
    const auto pair = reader.next().value();
    EXPECT_EQ(pair->depth.pts, pair->color.pts);
  }
}

TEST(PairReader, LostColourIsTheCallersError) {
  MockFilm film;
  film.color.lose_after_packets = 10;
  ASSERT_TRUE(film.reader.open({.url = "color", .depth_url = "depth"}).has_value());
  Result<std::optional<FramePair>> pair;
  int pairs = -1;
  do {
    pair = film.reader.next();
    ++pairs;
  } while (pair);
  EXPECT_EQ(pair.error().code, ErrorCode::Lost);
  EXPECT_EQ(film.reader.failedThing(), "color");
  EXPECT_GE(pairs, 8);
}

TEST(PairReader, InterruptHoldsUntilTheNextOpen) {
  MockFilm film;
  ASSERT_TRUE(film.reader.open({.url = "color", .depth_url = "depth"}).has_value());
  film.reader.interrupt();
  Result<std::optional<FramePair>> pair;
  do pair = film.reader.next();
  while (pair);
  EXPECT_EQ(pair.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(film.reader.seek(MediaTime{}).error().code, ErrorCode::Cancelled);
  film.sources = 0;
  EXPECT_TRUE(film.reader.open({.url = "color", .depth_url = "depth"}).has_value());
  EXPECT_TRUE(film.reader.next().has_value());
}

// Calls `at_read` before each read.
class ToldSource final : public MediaSource {
 public:
  ToldSource(std::unique_ptr<MediaSource> source, std::function<void()> at_read)
      : source_(std::move(source)), at_read_(std::move(at_read)) {}

 private:
  Result<Description> openSource(const std::string& url) override {
    if (auto opened = source_->open(url); !opened) return std::unexpected(opened.error());
    return Description{source_->streams(), source_->tags(), source_->duration()};
  }
  Result<std::optional<Packet>> readPacket() override {
    at_read_();
    return source_->read();
  }
  Result<void> seekTo(MediaTime target) override { return source_->seek(target); }
  void closeSource() noexcept override { source_->close(); }
  void interrupted() noexcept override { source_->interrupt(); }
  std::unique_ptr<MediaSource> source_;
  std::function<void()> at_read_;
};

// A black film of 60 pictures, of which 40 and those that follow are looked at for one that tells something.
TEST(PairReader, AnInterruptEndsTheLookAtLaterPictures) {
  TemporaryFolder folder;
  ClipTrack black = color(30, 60);
  black.sample = [](int, int, int, int) { return 0u; };
  makeClip(folder / "a.mkv", {black});
  PairReader* reading = nullptr;
  int scouted = 0, interrupt_at = 1000;
  const auto atRead = [&] {
    if (++scouted == interrupt_at) reading->interrupt();
  };
  PairReader::Backends backends = kFfmpeg;
  backends.make_source = [&, sources = 0](const std::string&) mutable -> std::unique_ptr<MediaSource> {
    if (sources++ % 2 == 0) return makeFfmpegSource();
    return std::make_unique<ToldSource>(makeFfmpegSource(), atRead);
  };
  PairReader reader(backends);
  reading = &reader;
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  EXPECT_GE(scouted, 40);
  scouted = 0, interrupt_at = 3;
  static_cast<void>(reader.open({.url = folder / "a.mkv"}));
  EXPECT_EQ(scouted, 3);
}

TEST(PairReader, VerbsWithoutAFilmAreRefused) {
  PairReader reader(kFfmpeg);
  EXPECT_EQ(reader.next().error().code, ErrorCode::InvalidState);
  EXPECT_EQ(reader.seek(MediaTime{}).error().code, ErrorCode::InvalidState);
  reader.interrupt();
  reader.close();
}

// Wherever the connection breaks between the seek and its first pair: the depth is read behind the colour.
TEST(PairReader, AfterALossBehindASeekItGoesOnAtTheTarget) {
  int losses = 0;
  for (std::uint64_t packets = 1; packets < 40; ++packets) {
    MockFilm film;
    film.depth.tracks = {MockTrack{}, MockTrack{.tags = {{"TITLE", "depth"}}}};
    film.depth.remote = true;
    film.color = film.depth;
    film.color.lose_after_packets = packets;  // once: the next connection is to `depth`
    const MediaTime target = film.color.tracks[0].pts(90);
    if (!film.reader.open({.url = "film"}) || !film.reader.seek(target)) continue;
    auto pair = film.reader.next();
    if (!pair) {
      ++losses;
      ASSERT_TRUE(film.reader.isSourceLost(pair.error()));
      ASSERT_TRUE(film.reader.reopen());
      pair = film.reader.next();
    }
    ASSERT_TRUE(pair && *pair);
    EXPECT_EQ((*pair)->color.pts, target) << packets;
  }
  EXPECT_GT(losses, 0);
}

}  // namespace
}  // namespace relievo
