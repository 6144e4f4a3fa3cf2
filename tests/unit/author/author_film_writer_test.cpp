// SPDX-License-Identifier: Apache-2.0
// A written film reads back with the same codes, timestamps, tags and key frames.
#include <gtest/gtest.h>

#include <vector>

#include "app/author/package/film_writer.h"
#include "app/scene/depth_calibration.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"
#include "tests/unit/author/written_films.h"

namespace relievo::test {
namespace {

class AuthorFilmWriter : public testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder_;
  [[nodiscard]] std::string path() const { return folder_ / (std::string("film") + GetParam()); }
};

TEST_P(AuthorFilmWriter, LosslessDepthComesBackCodeByCode) {
  FilmFormat format = formatOf(64, 48);
  format.depth.crf = 0;
  writeFilm(
      path(), format, regularTimes(12),
      [](int k) { return depthPicture(64, 48, [k](int c, int r) { return scattered(c, r, k); }); },
      [](int k) { return k == 0; });
  const ReadFilm film = readFilm(path());
  const auto& frames = film.frames.at(1);
  ASSERT_EQ(frames.size(), 12u);
  for (int k = 0; k < 12; ++k) {
    const Frame& frame = frames[static_cast<std::size_t>(k)];
    EXPECT_EQ(frame.range, ColorRange::Full);
    for (int r = 0; r < 48; ++r) {
      for (int c = 0; c < 64; ++c)
        ASSERT_EQ(test::sampleAt(frame, 0, c, r), scattered(c, r, k)) << c << "," << r << " of " << k;
    }
  }
}

// Black and white in limited range are 16 and 235: if anything rescaled the codes, 0 and 255 would not come back, and
// the slope would be wrong by up to 20 codes.
TEST_P(AuthorFilmWriter, CodedDepthIsNotRescaled) {
  writeFilm(
      path(), formatOf(256, 64), regularTimes(8),
      [](int) { return depthPicture(256, 64, [](int c, int) { return static_cast<std::uint8_t>(c); }); },
      [](int k) { return k == 0; });
  const ReadFilm film = readFilm(path());
  ASSERT_EQ(film.frames.at(1).size(), 8u);
  for (const Frame& frame : film.frames.at(1)) {
    for (int c = 0; c < 256; ++c) ASSERT_NEAR(static_cast<double>(test::sampleAt(frame, 0, c, 30)), c, 3);
    EXPECT_LE(test::sampleAt(frame, 0, 0, 30), 1u);
    EXPECT_GE(test::sampleAt(frame, 0, 255, 30), 254u);
  }
}

// chroma_format_idc of the sequence parameter set is the second Exp-Golomb number after profile, constraints and level:
// the first is the set's number, 0, coded "1"; 0 (4:0:0) is "1", 1 (4:2:0) is "010".
TEST_P(AuthorFilmWriter, DepthIsMonochromeAndColourIs420) {
  writeFilm(
      path(), formatOf(64, 48), regularTimes(3),
      [](int) { return depthPicture(64, 48, [](int, int) { return std::uint8_t{77}; }); },
      [](int k) { return k == 0; });
  const ReadFilm film = readFilm(path());
  ASSERT_EQ(film.streams.size(), 2u);
  const auto chromaBits = [&](std::size_t stream) { return film.streams[stream].extradata.at(12) >> 4; };
  EXPECT_EQ(film.streams[0].codec, "h264");
  EXPECT_EQ(film.streams[1].codec, "h264");
  EXPECT_EQ(chromaBits(0), 0b1010);
  EXPECT_EQ(chromaBits(1) >> 2, 0b11);
  // 12 macroblocks at 30 pictures/s: level 1.0. At the 90,000 ticks/s of the time base it would be 4.2.
  EXPECT_EQ(film.streams[0].extradata.at(11), 10);
}

TEST_P(AuthorFilmWriter, KeepsTheTimes) {
  // A film with a gap and uneven steps.
  std::vector<MediaTime> times;
  for (const int ms : {0, 33, 67, 100, 400, 417, 500, 1500}) times.emplace_back(std::chrono::milliseconds(ms));
  writeFilm(
      path(), formatOf(64, 48), times,
      [](int k) { return depthPicture(64, 48, [k](int, int) { return static_cast<std::uint8_t>(10 * k); }); },
      [](int k) { return k == 0; });
  const ReadFilm film = readFilm(path());
  for (const int stream : {0, 1}) {
    const auto& frames = film.frames.at(stream);
    ASSERT_EQ(frames.size(), times.size());
    for (std::size_t k = 0; k < times.size(); ++k) {
      EXPECT_NEAR(toSeconds(frames[k].pts), toSeconds(times[k]), 12e-6) << "stream " << stream << " picture " << k;
    }
  }
  // Each depth picture has its own time: the codes identify it.
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_NEAR(static_cast<double>(test::sampleAt(film.frames.at(1)[k], 0, 30, 20)), 10.0 * static_cast<double>(k), 1);
  }
}

TEST_P(AuthorFilmWriter, NamesItsTracks) {
  writeFilm(
      path(), formatOf(64, 48), regularTimes(2), [](int) { return depthPicture(64, 48, [](int, int) { return 9; }); },
      [](int k) { return k == 0; });
  const ReadFilm film = readFilm(path());
  ASSERT_EQ(film.streams.size(), 2u);
  // MP4's own track title is written too, but this library does not read it.
  const char* const key = std::string(GetParam()) == ".mkv" ? "TITLE" : "HANDLER_NAME";
  for (const auto& [stream, name] : {std::pair{0, "color"}, {1, "depth"}}) {
    ASSERT_TRUE(film.streams[static_cast<std::size_t>(stream)].tags.contains(key)) << name;
    EXPECT_EQ(film.streams[static_cast<std::size_t>(stream)].tags.at(key), name);
  }
}

TEST_P(AuthorFilmWriter, WritesTheCalibrationWhereAReaderFindsIt) {
  FilmFormat format = formatOf(64, 48);
  const DepthCalibration meaning{.law = DepthLaw::Inverse, .invalid = 0, .near_mm = 412.5, .far_mm = 3100};
  format.depth_tags = calibrationTags(meaning);
  writeFilm(
      path(), format, regularTimes(3),
      [](int) { return depthPicture(64, 48, [](int, int) { return std::uint8_t{77}; }); },
      [](int k) { return k == 0; });
  const ReadFilm film = readFilm(path());
  auto tags = film.streams.at(1).tags;
  tags.insert(film.tags.begin(), film.tags.end());
  const CalibrationSettings settings = calibrationFromTags(tags);
  EXPECT_EQ(settings.at("law"), "inverse");
  EXPECT_EQ(settings.at("near"), "412.5");
  EXPECT_EQ(settings.at("far"), "3100");
  EXPECT_EQ(settings.at("invalid"), "0");
  EXPECT_EQ(settings.at("polarity"), "near-high");
  EXPECT_EQ(settings.at("range"), "full");
  EXPECT_EQ(settings.at("bits"), "8");
  EXPECT_EQ(tags.at("HANDLER_NAME"), "depth");
  EXPECT_EQ(film.streams.at(0).tags.at("HANDLER_NAME"), "color");
  if (std::string(GetParam()) == ".mkv") {
    EXPECT_EQ(film.streams.at(0).tags.at("TITLE"), "color");
    EXPECT_EQ(film.streams.at(1).tags.at("TITLE"), "depth");
    EXPECT_EQ(film.streams.at(1).tags.count("DEPTH_LAW"), 1u);
    EXPECT_EQ(film.streams.at(0).tags.count("DEPTH_LAW"), 0u);
  }
}

TEST_P(AuthorFilmWriter, PutsKeyFramesWhereItIsTold) {
  // A cut at 40, where an encoder would insert a key frame by itself.
  const auto key = [](int k) { return k % 70 == 0; };
  writeFilm(
      path(), formatOf(64, 48), regularTimes(80),
      [](int k) {
        return depthPicture(
            64, 48, [k](int c, int r) { return k < 40 ? static_cast<std::uint8_t>(c + r) : scattered(c, r, 0); });
      },
      key);
  const ReadFilm film = readFilm(path());
  std::vector<MediaTime> expected;
  for (int k = 0; k < 80; k += 70) expected.push_back(film.frames.at(0)[static_cast<std::size_t>(k)].pts);
  EXPECT_EQ(film.keys.at(0), expected);
  EXPECT_EQ(film.keys.at(1), expected);
}

TEST_P(AuthorFilmWriter, TakesDepthOfAnotherSizeAndRate) {
  FilmFormat format = formatOf(128, 96);
  format.depth_width = 33;  // 4:0:0 may be odd
  format.depth_height = 25;
  {
    auto writer = FilmWriter::create(path(), format);
    ASSERT_TRUE(writer.has_value());
    for (int k = 0; k < 20; ++k) {
      ASSERT_TRUE((*writer)->writeColor(colorPicture(128, 96, k), mediaTime(k / 30.0), k == 0).has_value());
      if (k % 2 != 0) continue;
      const auto picture = depthPicture(33, 25, [k](int, int) { return static_cast<std::uint8_t>(100 + k); });
      ASSERT_TRUE((*writer)->writeDepth(picture, mediaTime(k / 30.0), k == 0).has_value());
    }
    ASSERT_TRUE((*writer)->finish().has_value());
  }
  const ReadFilm film = readFilm(path());
  ASSERT_EQ(film.frames.at(0).size(), 20u);
  ASSERT_EQ(film.frames.at(1).size(), 10u);
  EXPECT_EQ(film.frames.at(1)[0].width, 33);
  EXPECT_EQ(film.frames.at(1)[0].height, 25);
  EXPECT_NEAR(toSeconds(film.frames.at(1)[3].pts), 6 / 30.0, 1e-3);
  EXPECT_NEAR(static_cast<double>(test::sampleAt(film.frames.at(1)[3], 0, 32, 24)), 106, 1);
}

INSTANTIATE_TEST_SUITE_P(Kinds, AuthorFilmWriter, testing::Values(".mkv", ".mp4", ".mov"));

}  // namespace
}  // namespace relievo::test
