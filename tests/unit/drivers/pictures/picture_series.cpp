// SPDX-License-Identifier: Apache-2.0
// Series of colour and depth that other things than words tell apart, and depth that is slower than the colour.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/drivers/pictures/picture_files.h"

namespace relievo {
namespace {
using test::Pictures;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST_F(Pictures, DepthOfASlowerCameraIsSpreadOverTheColour) {
  const auto write = [&](const std::string& place, int color, int depth, int first = 0) {
    for (int k = 0; k < color; ++k) file(place + "/rgb/" + std::to_string(1000 + first + k) + ".png");
    for (int k = 0; k < depth; ++k) file(place + "/depth/" + std::to_string(1000 + k) + ".png");
    return read(folder_ / place, 30);
  };
  const Film slow = write("a", 36, 12);
  EXPECT_EQ(slow.depth[1], "100 a/depth/1001.png");
  EXPECT_EQ(slow.depth.back(), "1100 a/depth/1011.png");
  EXPECT_THAT(slow.notes, Contains(HasSubstr("one for every 3 is assumed")));
  EXPECT_EQ(write("b", 37, 12).depth.back(), "1100 b/depth/1011.png") << "the last of its colours are missing";
  for (const auto& [place, color, depth] : {std::tuple{"f", 100, 4}, {"g", 60, 10}, {"h", 300, 20}}) {
    EXPECT_EQ(write(place, color, depth).depth[1], std::string("33.3333 ") + place + "/depth/1001.png") << "by chance";
  }
  const Film between = write("c", 22, 9);
  EXPECT_EQ(between.depth[1], "33.3333 c/depth/1001.png");
  EXPECT_THAT(between.notes, Contains(HasSubstr("taken to end early")));
  EXPECT_THAT(write("d", 24, 20).notes, Each(Not(HasSubstr("counted alike"))));
  EXPECT_THAT(write("e", 24, 4, 1).notes, Each(Not(HasSubstr("counted alike")))) << "of one clock";
}

// As Isaac Sim writes them.
TEST_F(Pictures, DistancesAreDepthAndSegmentsAreNeither) {
  for (const char* k : {"0000", "0001"}) {
    for (const char* name : {"rgb_", "semantic_segmentation_"}) file("a/" + std::string(name) + k + ".png");
    file("a/distance_to_image_plane_" + std::string(k) + ".npy"), file("b/photo_" + std::string(k) + ".png");
    file("b/semantic_" + std::string(k) + ".png");
  }
  const Film film = read(folder_ / "a", 10);
  EXPECT_THAT(film.color, ElementsAre("0 a/rgb_0000.png", "100 a/rgb_0001.png"));
  EXPECT_THAT(film.depth,
              ElementsAre("0 a/distance_to_image_plane_0000.npy", "100 a/distance_to_image_plane_0001.npy"));
  EXPECT_THAT(read(folder_ / "b", 10).color, ElementsAre("0 b/photo_0000.png", "100 b/photo_0001.png"));
}

TEST_F(Pictures, ATiffOfGrayIsTheDepthOfItsPhoto) {
  const auto tiff = [&](const std::string& name, char bits, char samples) {
    std::string text("II*\0\x8\0\0\0\2\0", 10);
    text += std::string("\2\1\3\0\1\0\0\0", 8) + bits + std::string(3, '\0');
    text += std::string("\x15\1\3\0\1\0\0\0", 8) + samples + std::string(7, '\0');
    file(name + ".tif", text), file(name + ".jpg");
  };
  tiff("a/1", 32, 1), tiff("b/1", 16, 3), tiff("c/1", 8, 1);
  EXPECT_EQ(read(folder_ / "a").depth.size(), 1u);
  for (const char* place : {"b", "c"}) EXPECT_TRUE(read(folder_ / place).depth.empty()) << place;
}

// AirSim gives each picture the number of its kind and its own time in ns.
TEST_F(Pictures, MapsOfFloatsAmongAsManyPicturesAreTheirDepth) {
  for (const char* name : {"img_Drone_0_0_1636123456700000000.png", "img_Drone_0_1_1636123456700400000.pfm",
                           "img_Drone_0_0_1636123456750000000.png", "img_Drone_0_1_1636123456750300000.pfm"})
    file(std::string("a/") + name);
  const Film film = read(folder_ / "a");
  EXPECT_THAT(film.color,
              ElementsAre("0 a/img_Drone_0_0_1636123456700000000.png", "50 a/img_Drone_0_0_1636123456750000000.png"));
  EXPECT_THAT(film.depth,
              ElementsAre("0 a/img_Drone_0_1_1636123456700400000.pfm", "50 a/img_Drone_0_1_1636123456750300000.pfm"));
}

TEST_F(Pictures, GrayOfSixteenBitsAmongColourIsDepth) {
  const auto png = [&](const std::string& name, int bits, int color) {
    std::string head = std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1", 24);
    file(name, head + static_cast<char>(bits) + static_cast<char>(color) + name);
  };
  for (const char* k : {"1", "2", "3"})
    png("a/c" + std::string(k) + ".png", 8, 2), png("a/e" + std::string(k) + ".png", 16, 0);
  const Film film = read(folder_ / "a");
  EXPECT_EQ(film.color.size(), 3u);
  ASSERT_EQ(film.depth.size(), 3u);
  EXPECT_THAT(film.depth.back(), HasSubstr("a/e3.png"));
  for (const char* k : {"1", "2", "3"}) png("b/e" + std::string(k) + ".png", 16, 0);
  EXPECT_TRUE(read(folder_ / "b").depth.empty()) << "one series";
}

TEST_F(Pictures, AFolderOfOneLetterHoldsDepth) {
  for (const char* depth : {"D", "dpt"}) {
    const std::string place = std::string("of_") + depth;
    for (const char* k : {"1", "2"}) {
      file(place + "/rgb/" + k + ".png"), file(place + "/" + depth + "/" + k + ".png");
      file(place + "/" + "more/" + k + ".png");
    }
    EXPECT_EQ(read(folder_ / place).depth.size(), 2u) << depth;
  }
}

TEST_F(Pictures, DepthThatCannotBeOpenedIsLeftOut) {
  for (const char* k : {"1", "2"}) file("a/" + std::string(k) + ".jpg"), file("a/" + std::string(k) + ".npz");
  const auto describe = [](const std::string& path) -> Result<StreamInfo> {
    if (path.ends_with(".npz")) return fail(ErrorCode::Unsupported, "has no picture");
    return StreamInfo{.codec = "mjpeg"};
  };
  const auto source = makePicturesSource(describe);
  ASSERT_TRUE(source->open(folder_ / "a"));
  EXPECT_EQ(source->streams().size(), 1u);
  EXPECT_THAT(source->notes(), Contains(testing::AllOf(HasSubstr("1.npz"), HasSubstr("has no picture"))));
}

TEST_F(Pictures, ATableOfNumbersHasTheCommandThatConvertsIt) {
  file("depth.txt", "1.250 1.251\n1.252 1.253\n");
  EXPECT_THAT(read(folder_ / "depth.txt").error->message, HasSubstr("numpy.loadtxt"));
}

TEST_F(Pictures, AFolderOfNumbersIsDepthWhateverItsName) {
  const std::string gray16 = std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x10\0", 26);
  for (const char* k : {"1", "2"}) {
    for (const char* place : {"a", "b", "c"}) file(std::string(place) + "/eins/" + k + ".png");
    file(std::string("a/alt/") + k + ".png", gray16), file(std::string("b/thermal/") + k + ".png", gray16);
    file(std::string("c/zwei/") + k + ".png");
  }
  const Film film = read(folder_ / "a");
  ASSERT_FALSE(film.error);
  EXPECT_EQ(film.color.front(), "0 a/eins/1.png");
  EXPECT_EQ(film.depth.size(), 2u);
  EXPECT_THAT(film.notes, Contains(HasSubstr("alt is taken for depth")));
  EXPECT_THAT(film.notes, Each(Not(HasSubstr("left out"))));
  for (const char* place : {"b", "c"}) EXPECT_THAT(read(folder_ / place).error->message, HasSubstr("--depth")) << place;
}

}  // namespace
}  // namespace relievo
