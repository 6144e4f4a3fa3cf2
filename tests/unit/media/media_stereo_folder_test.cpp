// SPDX-License-Identifier: Apache-2.0
// Folders of two views and their disparities, as stereo data sets name them, opened as one picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::distanceMm;
using test::kSceneCols;
using test::kSceneRows;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class StereoFolder : public testing::Test {
 protected:
  // Views differ in their brightness: `shade` of the first sample.
  void view(const std::string& name, std::uint32_t shade) const {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    ClipTrack track{.codec = "png", .pix_fmt = "rgb24", .width = kSceneCols, .height = kSceneRows, .frames = 1};
    track.sample = [shade](int, int c, int, int) { return c == 0 ? shade : 50u; };
    test::makeClip(folder_ / name, {track});
  }
  // round(px(mm)), and 0 for a hole.
  void disparities(const std::string& name, const std::function<double(double mm)>& px) const {
    ClipTrack track{.codec = "png", .pix_fmt = "gray", .width = kSceneCols, .height = kSceneRows, .frames = 1};
    track.sample = [px](int, int c, int r, int) {
      const double mm = distanceMm(c, r);
      return mm == 0 ? 0u : static_cast<std::uint32_t>(std::lround(px(mm)));
    };
    test::makeClip(folder_ / name, {track});
  }
  // Rows from the bottom up, little endian; infinity for a hole.
  void pfm(const std::string& name, const std::function<double(double mm)>& px) const {
    std::ofstream file(folder_ / name, std::ios::binary);
    file << "Pf\n" << kSceneCols << " " << kSceneRows << "\n-1\n";
    for (int r = kSceneRows - 1; r >= 0; --r) {
      for (int c = 0; c < kSceneCols; ++c) {
        const double mm = distanceMm(c, r);
        const auto value = mm == 0 ? std::numeric_limits<float>::infinity() : static_cast<float>(px(mm));
        char word[4];
        std::memcpy(word, &value, 4);
        file.write(word, 4);
      }
    }
  }
  [[nodiscard]] test::OpenedFilm open() const { return test::openFilm({.url = folder_ / "."}); }
  // One picture, the left one, and distances within `off` of a reading; the ball's centre is nearer than the wall.
  static void expectStill(const test::OpenedFilm& film, double off, double scale = 1) {
    ASSERT_TRUE(film.info.has_depth);
    EXPECT_EQ(film.info.duration, Duration(0));
    EXPECT_EQ(test::sampleAt(film.pair.color, 0, 0, 0), 200u);
    for (int r = 10; r < kSceneRows; r += 9) {
      for (int c = 20; c < kSceneCols; c += 7) {
        EXPECT_NEAR(film.distanceAt(c, r) * scale, distanceMm(c, r), off * distanceMm(c, r)) << c << " " << r;
      }
    }
    EXPECT_TRUE(std::isnan(film.heightAt(5, 60)));
  }
  test::TemporaryFolder folder_;
};

TEST_F(StereoFolder, OfMiddlebury2014HasTheDistancesOfItsCameras) {
  view("im0.png", 200), view("im1.png", 100);
  const auto px = [](double mm) { return 400 * 120 / mm - 20; };
  pfm("disp0.pfm", px), pfm("disp1.pfm", [](double) { return 1; });
  disparities("disp0.png", [](double) { return 7; });  // a picture to look at
  std::ofstream(folder_ / "calib.txt") << "cam0=[400 0 80; 0 400 54; 0 0 1]\ndoffs=20\nbaseline=120\n";
  const test::OpenedFilm film = open();
  expectStill(film, 0.003);
  EXPECT_THAT(film.info.reading.why, Contains(HasSubstr("calib.txt")));
}

// One view alone is shown; the other is named, so that both can be seen and felt.
TEST_F(StereoFolder, OneViewByItselfNamesTheOther) {
  for (const char* name : {"left.png", "right.png", "a_L.png", "a_R.png", "street/im0.png", "street/im1.png", "c.png"})
    view(name, 200);
  const auto notes = [&](const char* name) { return test::openFilm({.url = folder_ / name}).info.notes; };
  EXPECT_THAT(notes("left.png"), Contains(AllOf(HasSubstr("/right.png beside it"), HasSubstr("--depth-from stereo"))));
  EXPECT_THAT(notes("right.png"), Contains(HasSubstr("/left.png beside it")));
  EXPECT_THAT(notes("a_L.png"), Contains(HasSubstr("/a_R.png beside it")));
  EXPECT_THAT(notes("street/im0.png"), Contains(HasSubstr("street/im1.png beside it")));
  view("street/im2.png", 200);
  EXPECT_THAT(notes("street/im0.png"), Not(Contains(HasSubstr("beside it")))) << "a series";
  EXPECT_THAT(notes("c.png"), Not(Contains(HasSubstr("beside it"))));
  disparities("left_disp.png", [](double mm) { return 90000 / mm; });
  EXPECT_THAT(notes("left.png"), Not(Contains(HasSubstr("right.png beside it"))));
}

// Z = 3740 px x 160 mm / (code + dmin), in every size.
TEST_F(StereoFolder, OfMiddlebury2006HasTheDistancesOfItsCameras) {
  for (int k = 0; k < 7; ++k) view("view" + std::to_string(k) + ".png", k == 1 ? 200 : 100);
  std::ofstream(folder_ / "dmin.txt") << "230\n";
  disparities("disp1.png", [](double mm) { return 3740 * 160 / (1.2 * mm) - 230; });
  disparities("disp5.png", [](double) { return 1; });
  expectStill(open(), 0.003, 1 / 1.2);
}

TEST_F(StereoFolder, OfMiddlebury2003HasDistancesOfUnknownScale) {
  for (const int k : {0, 1, 2, 3, 6}) view("im" + std::to_string(k) + ".png", k == 2 ? 200 : 100);
  disparities("disp2.png", [](double mm) { return 250 * 1100 / mm; });
  disparities("disp6.png", [](double) { return 1; });
  const test::OpenedFilm film = open();
  expectStill(film, 0.004, distanceMm(80, 54) / film.distanceAt(80, 54));
  EXPECT_THAT(film.info.reading.why, Contains(HasSubstr("2003")));
}

TEST_F(StereoFolder, WithoutDisparitiesIsAStereoPair) {
  view("left.png", 200), view("right.png", 100);
  const test::OpenedFilm film = open();
  EXPECT_FALSE(film.info.has_depth);
  EXPECT_EQ(film.info.packing, Packing::StereoTracks);
  EXPECT_EQ(test::sampleAt(film.pair.color, 0, 0, 0), 200u);
  ASSERT_FALSE(film.pair.right.empty());
  EXPECT_EQ(test::sampleAt(film.pair.right, 0, 0, 0), 100u);
}

TEST_F(StereoFolder, OfFoldersIsAFilmOfStereoPairs) {
  for (int k = 0; k < 3; ++k) {
    view("left/" + std::to_string(k) + ".png", 200);
    view("right/" + std::to_string(k) + ".png", 100);
  }
  const test::OpenedFilm film = open();
  EXPECT_EQ(film.info.packing, Packing::StereoTracks);
  EXPECT_NEAR(toSeconds(film.info.duration), 0.1, 1e-3);
  ASSERT_FALSE(film.pair.right.empty());
  EXPECT_EQ(test::sampleAt(film.pair.right, 0, 0, 0), 100u);
}

// Of 12 bits, as machine vision's cameras store them: both views are stretched to the same brightness.
TEST_F(StereoFolder, OfPgmsHasViewsOfOneBrightness) {
  for (const char* view : {"left", "right"}) {
    std::filesystem::create_directories(folder_ / view);
    for (int k = 0; k < 3; ++k) {
      std::ofstream file(folder_ / (std::string(view) + "/" + std::to_string(k) + ".pgm"), std::ios::binary);
      file << "P5\n32 24\n4095\n";
      for (int i = 0; i < 32 * 24; ++i) file.put('\x08').put(static_cast<char>(i % 251));
    }
  }
  const test::OpenedFilm film = open();
  ASSERT_FALSE(film.pair.color.empty());
  ASSERT_FALSE(film.pair.right.empty());
  EXPECT_EQ(test::sampleAt(film.pair.color, 0, 4, 4), test::sampleAt(film.pair.right, 0, 4, 4));
}

// The left view is the colour; the right one is left out with a word.
TEST_F(StereoFolder, OfTwoViewsAndTheirDepthIsAFilmOfTheLeftView) {
  const auto expectLeftView = [&](const std::string& name, std::size_t left_out) {
    const test::OpenedFilm film = test::openFilm({.url = folder_ / name});
    ASSERT_TRUE(film.info.has_depth) << name;
    EXPECT_NEAR(toSeconds(film.info.duration), 0.1, 1e-3) << name;
    ASSERT_FALSE(film.pair.color.empty()) << name;
    EXPECT_EQ(test::sampleAt(film.pair.color, 0, 0, 0), 200u) << name;
    EXPECT_EQ(test::sampleAt(film.pair.depth, 0, 80, 20), 120u) << name;
    EXPECT_THAT(film.info.notes, Contains(std::to_string(left_out) + " other pictures are left out")) << name;
  };
  for (int k = 0; k < 3; ++k) {
    const std::string number = std::to_string(k) + ".png";
    view("f/left/" + number, 200), view("f/right/" + number, 100);
    std::filesystem::create_directories(folder_ / "f/depth");
    view("m/left" + number, 200), view("m/right" + number, 100);
    view("w/" + std::to_string(k) + ".left.png", 200), view("w/" + std::to_string(k) + ".right.png", 100);
    for (const char* depth : {"f/depth/", "m/depth"}) disparities(depth + number, [](double) { return 120; });
    disparities("w/" + std::to_string(k) + ".left.depth.png", [](double) { return 120; });
    disparities("w/" + std::to_string(k) + ".right.depth.png", [](double) { return 60; });
  }
  expectLeftView("f", 3), expectLeftView("m", 3), expectLeftView("w", 6);
}

TEST_F(StereoFolder, ThreePicturesInARowAreAFilm) {
  for (int k = 0; k < 3; ++k) view("im" + std::to_string(k) + ".png", 100);
  const test::OpenedFilm film = open();
  EXPECT_EQ(film.info.packing, Packing::Tracks);
  EXPECT_GT(film.info.duration, Duration(0));
}

}  // namespace
}  // namespace relievo
