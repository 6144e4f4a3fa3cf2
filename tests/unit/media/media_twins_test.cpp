// SPDX-License-Identifier: Apache-2.0
// Photos and the numbers that a program has put beside them under the same name; codes as text; series of gray.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/media/folder/film_folder.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::distanceMm;
using test::makeClip;
using test::OpenedFilm;
using test::openFilm;
using testing::Contains;
using testing::HasSubstr;

constexpr int kCols = test::kSceneCols, kRows = test::kSceneRows;

double metresAt(int c, int r) {
  return (distanceMm(c, r) == 0 ? 2000 : distanceMm(c, r)) / 1000;
}

// As NumPy begins a file.
std::string headOf(const std::string& type, const std::string& shape) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.resize(117, ' ');
  return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(header.size() + 1) + '\0' + header + '\n';
}

// Arrays of rows x columns.
std::string array(int pictures = 1) {
  std::string bytes = headOf("<f4", (pictures > 1 ? std::to_string(pictures) + ", " : "") + "108, 160");
  for (int i = 0; i < pictures * kCols * kRows; ++i) {
    const auto sample = static_cast<float>(metresAt(i % kCols, i / kCols % kRows));
    bytes.append(reinterpret_cast<const char*>(&sample), sizeof sample);
  }
  return bytes;
}
std::string colors() {
  std::string bytes = headOf("|u1", "108, 160, 3");
  for (int i = 0; i < 3 * kCols * kRows; ++i) bytes += static_cast<char>(i % 3 * 80 + i % 40);
  return bytes;
}

class Twins : public testing::Test {
 protected:
  void picture(const std::string& name, const char* codec, const char* format, bool depth = false) const {
    ClipTrack track{.codec = codec, .pix_fmt = format, .width = kCols, .height = kRows, .frames = 1};
    track.sample = [depth](int k, int c, int r, int) {
      if (depth) return static_cast<std::uint32_t>(std::lround(1000 * metresAt(c, r)));
      return static_cast<std::uint32_t>(std::lround(255 * test::photoOf(c, r)[static_cast<std::size_t>(k)]));
    };
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    makeClip(folder_ / name, {track});
  }
  void photo(const std::string& name) const { picture(name, "mjpeg", "yuvj444p"); }
  void write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  // Python's zipfile, as numpy.savez uses it.
  void archive(const std::string& name) const {
    write("array.npy", array());
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    const std::string script = "import sys, zipfile; zipfile.ZipFile(sys.argv[1], 'w').write(sys.argv[2], 'depth.npy')";
    const std::string command =
        "python3 -c \"" + script + "\" '" + folder_ / name + "' '" + folder_ / "array.npy" + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
  }
  static void expectDepth(const OpenedFilm& film) {
    ASSERT_TRUE(film.info.has_depth);
    EXPECT_EQ(film.info.packing, Packing::Tracks);
    EXPECT_NEAR(film.distanceAt(80, 54), 1000 * metresAt(80, 54), 6);
    EXPECT_NEAR(film.distanceAt(150, 10), 1000 * metresAt(150, 10), 6);
  }

  const test::TemporaryFolder folder_;
};

TEST_F(Twins, APhotoGivenAloneTakesTheNumbersOfItsName) {
  photo("a/IMG_1.jpg"), write("a/IMG_1.npy", array());
  photo("b/IMG_1.jpg"), picture("b/IMG_1.png", "png", "gray16be", true);
  photo("c/IMG_1.jpg"), archive("c/IMG_1.npz");
  for (const char* place : {"a", "b", "c"}) {
    SCOPED_TRACE(place);
    const OpenedFilm film = openFilm({.url = folder_ / (std::string(place) + "/IMG_1.jpg")});
    expectDepth(film);
    EXPECT_THAT(film.info.notes, Contains(HasSubstr("beside the film")));
  }
}

TEST_F(Twins, APhotoInAnotherFormIsNoDepth) {
  picture("m/1.png", "png", "gray16be", true), write("m/1.npy", array());  // MiDaS writes the depth twice
  EXPECT_EQ(openFilm({.url = folder_ / "m/1.png"}).info.packing, Packing::DepthAlone);
  for (const auto& [name, codec, format] :
       {std::array{"a/1.png", "png", "rgb24"}, std::array{"b/1.tif", "tiff", "rgb24"},
        std::array{"c/1.png", "png", "gray"}, std::array{"d/1.tif", "tiff", "rgb48le"}}) {
    const std::string photo_name = std::string(name).substr(0, 2) + "1.jpg";
    photo(photo_name), picture(name, codec, format);
    EXPECT_FALSE(openFilm({.url = folder_ / photo_name}).info.has_depth) << name;
  }
  photo("e/1.jpg"), write("e/1.npy", colors());
  EXPECT_FALSE(openFilm({.url = folder_ / "e/1.jpg"}).info.has_depth) << "colours, not depth";
  photo("F/IMG_1.JPG"), picture("F/img_1.png", "png", "rgb24");
  EXPECT_FALSE(openFilm({.url = folder_ / "F/IMG_1.JPG"}).info.has_depth);
}

TEST_F(Twins, NumbersGivenAloneTakeTheirPhoto) {
  photo("a/IMG_1.jpg"), write("a/IMG_1.npy", array());
  const OpenedFilm film = openFilm({.url = folder_ / "a/IMG_1.npy"});
  expectDepth(film);
  EXPECT_EQ(film.pair.color.model, ColorModel::Yuv);
}

TEST_F(Twins, AFilmOfNumbersIsNotThatOfItsThumbnail) {
  photo("a/clip.jpg"), write("a/clip.npy", array(3));
  const OpenedFilm film = openFilm({.url = folder_ / "a/clip.npy"});
  EXPECT_EQ(film.info.packing, Packing::DepthAlone);
}

// Poses, masks and the like of the pictures' names.
TEST_F(Twins, WhatLiesBesideNamedPicturesIsNoColour) {
  for (const std::string k : {"1", "2", "3"}) {
    photo("a/" + k + "_rgb.jpg"), write("a/" + k + "_depth.npy", array()), archive("a/" + k + "_cam.npz");
    picture("b/" + k + ".png", "png", "gray16be", true), write("b/" + k + ".npz", "x");
    picture("c/" + k + ".png", "png", "gray16be", true), picture("c/" + k + "_mask.png", "png", "gray16be", false);
  }
  const OpenedFilm named = openFilm({.url = folder_ / "a"});
  EXPECT_EQ(named.pair.color.model, ColorModel::Yuv);
  EXPECT_NEAR(named.distanceAt(80, 54), 1000 * metresAt(80, 54), 6);
  for (const char* place : {"b", "c"}) {
    const OpenedFilm depth = openFilm({.url = folder_ / place});
    EXPECT_EQ(depth.info.packing, Packing::DepthAlone) << place;
    EXPECT_NEAR(depth.distanceAt(80, 54), 1000 * metresAt(80, 54), 6) << place;
  }
}

// Depth Pro's.
TEST_F(Twins, AFolderOfArchivesIsASeries) {
  for (const char* k : {"1", "2"}) {
    archive("a/" + std::string(k) + ".npz");
    photo("b/" + std::string(k) + ".jpg"), archive("b/" + std::string(k) + ".npz");
  }
  const OpenedFilm alone = openFilm({.url = folder_ / "a"});
  EXPECT_EQ(alone.info.packing, Packing::DepthAlone);
  EXPECT_NEAR(alone.distanceAt(80, 54), 1000 * metresAt(80, 54), 6);
  EXPECT_GT(alone.info.duration, Duration(0));
  expectDepth(openFilm({.url = folder_ / "b"}));
}

TEST_F(Twins, DepthCraftersArchiveIsOfItsInput) {
  for (const char* name : {"clip_input.mp4", "clip.npz", "clip.mp4"}) write(name, "");
  EXPECT_EQ(depthBeside(folder_ / "clip_input.mp4"), folder_ / "clip.npz");
}

TEST_F(Twins, CodesThatATextHoldsStayWhateverTheirHighestOneIs) {
  std::string text = "P2\n# mm\n160 108\n5000\n";
  for (int i = 0; i < kCols * kRows; ++i)
    text += std::to_string(std::lround(1000 * metresAt(i % kCols, i / kCols))) + " ";
  write("a.pgm", text);
  const OpenedFilm film = openFilm({.url = folder_ / "a.pgm"});
  EXPECT_EQ(film.info.calibration.calibration.unit_mm, 1);
  EXPECT_NEAR(film.distanceAt(80, 54), 1000 * metresAt(80, 54), 2);
}

TEST_F(Twins, GrayWhoseFilesSayDepthIsDepthAlone) {
  for (const char* k : {"1", "2"}) picture("a/frame_" + std::string(k) + "_depth.png", "png", "gray");
  EXPECT_EQ(openFilm({.url = folder_ / "a"}).info.packing, Packing::DepthAlone);
  for (const char* k : {"1", "2"}) picture("b/frame_" + std::string(k) + ".png", "png", "gray");
  EXPECT_FALSE(openFilm({.url = folder_ / "b"}).info.has_depth);
}

TEST_F(Twins, ColoursThatANameSaysAreDepthAreToldToPlayFlat) {
  for (const char* name : {"room_depth.png", "room.png"}) picture(name, "png", "rgb24");
  EXPECT_THAT(openFilm({.url = folder_ / "room_depth.png"}).info.reading.doubts,
              Contains(HasSubstr("--packing depth-alone --depth-code turbo")));
  EXPECT_THAT(openFilm({.url = folder_ / "room.png"}).info.reading.doubts,
              testing::Each(testing::Not(HasSubstr("its name says depth"))));
  for (const char* name : {"Out of My Depth.png", "in_depth_talk.png", "depth/talk.png"}) {
    picture(name, "png", "rgb24");
    const OpenedFilm film = openFilm({.url = folder_ / name});
    EXPECT_THAT(film.info.reading.doubts, testing::Each(testing::Not(HasSubstr("its name says depth")))) << name;
  }
}

}  // namespace
}  // namespace relievo
