// SPDX-License-Identifier: Apache-2.0
// relievo-author from end to end: the times of colour and depth, lengths that differ, key frames, interruptions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <vector>

#include "app/author/author.h"
#include "app/scene/height_field.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/scenario/author/author_film.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/mkv_patch.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(AuthorFilm, WritesADepthOfALowerRateOnceAPicture) {
  ClipTrack depth = depthTrack("gray", [](int, int, int k) { return static_cast<std::uint32_t>(10 * k); });
  depth.fps_num = 15;
  depth.frames = 15;
  const AuthorSummary summary = package(colorTrack(), depth);
  EXPECT_EQ(summary.totals.color.frames, 30u);
  EXPECT_EQ(summary.totals.depth.frames, 15u);
  const Film film = readFilm(folder_ / "out.mkv");
  ASSERT_EQ(film.pairs.size(), 30u);
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_EQ(film.code(k, 3, 3), static_cast<int>(10 * (k / 2))) << k;
    EXPECT_NEAR(toSeconds(film.pairs[k].depth.pts), static_cast<double>(k / 2) / 15, 6e-4) << k;
  }
}

// Every row of the odd field shows the square further right.
TEST_F(AuthorFilm, AnInterlacedFilmHasNoCombs) {
  ClipTrack color = colorTrack();
  color.codec = "libx264";
  color.options = {{"flags", "+ildct+ilme"}, {"crf", "1"}};
  color.sample = [](int component, int c, int r, int) {
    const int left = r % 2 == 0 ? 16 : 32;
    return component > 0 ? 128u : c >= left && c < left + 16 ? 200u : 40u;
  };
  makeClip(folder_ / "film.mkv",
           {color, depthTrack("gray", [](int, int r, int) { return 50u + static_cast<unsigned>(r); })});
  ASSERT_TRUE(make({.url = folder_ / "film.mkv"}).has_value());
  const Film film = readFilm(folder_ / "out.mkv");
  for (int r = 4; r < 44; ++r) {
    const auto left = static_cast<int>(test::sampleAt(film.pairs.at(3).color, 0, 24, r));
    const auto right = static_cast<int>(test::sampleAt(film.pairs.at(3).color, 0, 40, r));
    EXPECT_NEAR(left + right, 240, 30) << r << ": one square";
    EXPECT_NEAR(left, test::sampleAt(film.pairs.at(3).color, 0, 24, 20), 30) << r << ": of one field";
  }
  EXPECT_FALSE(film.pairs.at(3).color.interlaced);
}

TEST_F(AuthorFilm, TimesThatJumpBackAreMended) {
  ClipTrack color = colorTrack(64, 48, 5, 75);
  color.codec = "libx264";
  ClipTrack depth = depthTrack("gray", [](int, int r, int) { return 50u + static_cast<unsigned>(r); });
  depth.fps_num = 5, depth.frames = 75;
  makeClip(folder_ / "film.mkv", {color, depth});
  ASSERT_GT(test::moveClustersBack(folder_ / "film.mkv", 6000, 4000), 0);
  const auto summary = make({.url = folder_ / "film.mkv"});
  ASSERT_TRUE(summary.has_value()) << summary.error().thing << summary.error().error.message;
  EXPECT_EQ(summary->totals.color.frames, 75u);
  EXPECT_NEAR(toSeconds(summary->totals.color.last - summary->totals.color.first), 14.8, 0.3);
}

TEST_F(AuthorFilm, ThinsADepthOfAHigherRateAndSaysSo) {
  ClipTrack depth = depthTrack("gray", [](int, int, int k) { return static_cast<std::uint32_t>(4 * k); });
  depth.fps_num = 60;
  depth.frames = 60;
  const AuthorSummary summary = package(colorTrack(), depth);
  EXPECT_EQ(summary.totals.depth.frames, 30u);
  ASSERT_FALSE(summary.notes.empty());
  EXPECT_THAT(summary.notes, testing::Contains(HasSubstr("depth pictures matched no colour picture")));
  const Film film = readFilm(folder_ / "out.mkv");
  EXPECT_EQ(film.code(7, 3, 3), 56);  // the depth of the same time: its picture 14
}

TEST_F(AuthorFilm, LetsTheDepthEndEarlier) {
  ClipTrack depth = depthTrack("gray", [](int, int, int) { return 50u; });
  depth.frames = 10;
  const AuthorSummary summary = package(colorTrack(), depth);
  EXPECT_EQ(summary.totals.color.frames, 30u);
  EXPECT_EQ(summary.totals.depth.frames, 10u);
  EXPECT_THAT(summary.notes,
              ElementsAre(HasSubstr("20 colour pictures have no depth"),
                          HasSubstr("the depth lasts 0.3 s, the colour 1.0 s"), HasSubstr("of the depth is one code")));
  const Film film = readFilm(folder_ / "out.mkv");
  EXPECT_FALSE(film.pairs[9].depth.empty());
  EXPECT_TRUE(film.pairs[12].depth.empty());
}

TEST_F(AuthorFilm, CountsPicturesWithoutDepthAndThoseWithTheOneBefore) {
  ClipTrack depth = depthTrack("gray", [](int, int, int) { return 50u; });
  depth.time = [](int k) -> std::optional<Duration> {
    if (k < 3 || (k >= 12 && k < 16)) return std::nullopt;  // begins late, and four are missing in the middle
    return Duration(k * 1'000'000'000LL / 30);
  };
  makeClip(folder_ / "film.mkv", {colorTrack(), depth});
  const auto summary = make({.url = folder_ / "film.mkv"});
  ASSERT_TRUE(summary.has_value());
  EXPECT_THAT(summary->notes, ElementsAre(HasSubstr("3 colour pictures have no depth"),
                                          HasSubstr("4 colour pictures lacked their depth picture"),
                                          HasSubstr("of the depth is one code")));
}

TEST_F(AuthorFilm, SaysThatASourceBreaksOff) {
  makeClip(folder_ / "film.mkv", {colorTrack(64, 48, 30, 90), depthTrack("gray", [](int, int, int) { return 9u; })});
  std::filesystem::resize_file(folder_ / "film.mkv", std::filesystem::file_size(folder_ / "film.mkv") / 2);
  const auto summary = make({.url = folder_ / "film.mkv"});
  ASSERT_TRUE(summary.has_value());
  ASSERT_FALSE(summary->notes.empty());
  EXPECT_THAT(summary->notes[0], HasSubstr("film.mkv lacks at least "));
}

TEST_F(AuthorFilm, PutsKeyFramesAtTheSamePlacesOfBothTracks) {
  ClipTrack depth = depthTrack(
      "gray", [](int c, int r, int k) { return static_cast<std::uint32_t>((c * 7 + r * 3 + k * 11) & 255); });
  depth.frames = 100;
  package(colorTrack(64, 48, 30, 100), depth);
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder_ / "out.mkv").has_value());
  std::map<int, std::vector<int>> keys;
  while (auto packet = source->read().value()) {
    if (packet->keyframe) keys[packet->stream].push_back(static_cast<int>(std::lround(toSeconds(*packet->pts) * 30)));
  }
  EXPECT_THAT(keys[0], ElementsAre(0, 30, 60, 90));
  EXPECT_THAT(keys[1], ElementsAre(0, 30, 60, 90));
}

TEST_F(AuthorFilm, LeavesNothingWhenItIsInterrupted) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int, int, int) { return 9u; })});
  std::uint64_t reached = 0;
  const auto stopAtFive = [&](std::uint64_t done, std::optional<std::uint64_t> total) {
    EXPECT_EQ(total, std::optional<std::uint64_t>(30));
    EXPECT_LE(made().size(), 1u);  // the temporary file, if it has a name
    reached = done;
    if (done == 5) stop_ = true;
  };
  const auto summary = authorFilm({.url = folder_ / "color.mkv", .depth_url = folder_ / "depth.mkv"}, kFfmpeg,
                                  {.path = folder_ / "out.mkv"}, stop_, stopAtFive);
  ASSERT_FALSE(summary.has_value());
  EXPECT_EQ(summary.error().error.code, ErrorCode::Cancelled);
  EXPECT_EQ(reached, 5u);
  EXPECT_TRUE(made().empty());
}

// A file that is read as a camera is: without a length, and each picture with a time of arrival.
class LiveFile final : public MediaSource {
  Result<Description> openSource(const std::string& url) override {
    if (auto opened = file_->open(url); !opened) return std::unexpected(opened.error());
    return Description{.streams = file_->streams(), .origin = {.remote = true}};
  }
  Result<std::optional<Packet>> readPacket() override {
    if (left_ == 0) return fail(ErrorCode::Unsupported, "another format");
    --left_;
    return file_->read();
  }
  Result<void> seekTo(MediaTime target) override { return file_->seek(target); }
  void closeSource() noexcept override { file_->close(); }
  void interrupted() noexcept override { file_->interrupt(); }

  std::unique_ptr<MediaSource> file_ = makeFfmpegSource();
  int left_;

 public:
  explicit LiveFile(int packets) : left_(packets) {}
};
PairReader::Backends liveOf(int packets) {
  return {[packets](const std::string&) { return std::make_unique<LiveFile>(packets); }, kFfmpeg.make_decoder};
}

TEST_F(AuthorFilm, OfACameraEndsWhereThePicturesChangeTheirSize) {
  std::string both;
  for (const int width : {64, 96}) {
    ClipTrack track = depthTrack("yuv420p", [](int c, int r, int) { return static_cast<unsigned>(c + r); }, width);
    track.codec = "libx264";
    makeClip(folder_ / "part.ts", {track});
    both += textOf(folder_ / "part.ts");
  }
  std::ofstream(folder_ / "film.ts") << both;
  const SourceOptions source{.url = folder_ / "film.ts", .packing = Packing::DepthAlone};
  const auto summary = authorFilm(source, liveOf(1000), {.path = folder_ / "out.mkv"}, stop_, kNoReport);
  ASSERT_TRUE(summary.has_value()) << summary.error().thing << summary.error().error.message;
  EXPECT_EQ(summary->totals.color.frames, 30u);
  EXPECT_EQ(readFilm(folder_ / "out.mkv").pairs.size(), 30u);
  EXPECT_FALSE(authorFilm(source, kFfmpeg, {.path = folder_ / "file.mkv"}, stop_, kNoReport)) << "a file is cut";
}

TEST_F(AuthorFilm, OfACameraFailsAtAnyOtherPictureThatCannotBeRead) {
  ClipTrack track = depthTrack("yuv420p", [](int c, int r, int) { return static_cast<unsigned>(c + r); });
  track.codec = "libx264";
  makeClip(folder_ / "film.ts", {track});
  const SourceOptions source{.url = folder_ / "film.ts", .packing = Packing::DepthAlone};
  const auto summary = authorFilm(source, liveOf(20), {.path = folder_ / "out.mkv"}, stop_, kNoReport);
  ASSERT_FALSE(summary.has_value());
  EXPECT_STREQ(summary.error().error.message, "another format");
}

TEST_F(AuthorFilm, SentOverTheNetworkItsSoundEndsWithThePicturesWhenItIsInterrupted) {
  makeClip(folder_ / "film.mkv", {colorTrack(), depthTrack("gray", [](int, int, int) { return 9u; })}, {},
           {{.codec = "aac", .length = std::chrono::seconds(60)}});
  const auto stopAtTen = [&](std::uint64_t done, std::optional<std::uint64_t>) { stop_ = done == 10; };
  const auto sent = authorFilm({.url = folder_ / "film.mkv"}, kFfmpeg, {.path = "udp://127.0.0.1:9"}, stop_, stopAtTen);
  ASSERT_TRUE(sent.has_value()) << sent.error().error.message;
  EXPECT_THAT(sent->kept, ElementsAre(testing::HasSubstr("sound aac")));
  EXPECT_EQ(sent->totals.color.frames, 10u);
  EXPECT_LT(sent->totals.file_bytes, 100'000u) << "a minute of sound has more";
}

TEST_F(AuthorFilm, LeavesNothingWhenTheSampleIsInterrupted) {
  const auto stopAtTwo = [&](std::uint64_t done, std::optional<std::uint64_t>) { stop_ = done == 2; };
  const auto summary = authorSample({.cols = 64, .rows = 48}, {.path = folder_ / "out.mkv"}, stop_, stopAtTwo);
  ASSERT_FALSE(summary.has_value());
  EXPECT_EQ(summary.error().error.code, ErrorCode::Cancelled);
  EXPECT_TRUE(made().empty());
}

TEST_F(AuthorFilm, PutsKeyFramesAtCuts) {
  // From a slope to its mirror image between 40 and 41; a second has its own at 30, and 71 is a second from the cut.
  ClipTrack depth =
      depthTrack("gray", [](int c, int, int k) { return static_cast<std::uint32_t>(k <= 40 ? 4 * c : 255 - 4 * c); });
  depth.frames = 80;
  package(colorTrack(64, 48, 30, 80), depth);
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder_ / "out.mkv").has_value());
  std::map<int, std::vector<int>> keys;
  while (auto packet = source->read().value()) {
    if (packet->keyframe) keys[packet->stream].push_back(static_cast<int>(std::lround(toSeconds(*packet->pts) * 30)));
  }
  EXPECT_THAT(keys[0], ElementsAre(0, 30, 41, 71));
  EXPECT_THAT(keys[1], ElementsAre(0, 30, 41, 71));
}

}  // namespace
}  // namespace relievo
