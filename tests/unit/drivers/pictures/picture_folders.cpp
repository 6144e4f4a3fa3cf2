// SPDX-License-Identifier: Apache-2.0
// Which folders of a recording are taken for its colour and its depth, and how far they are looked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/pictures/recording.h"
#include "tests/unit/drivers/pictures/picture_files.h"

namespace relievo {
namespace {
using test::Pictures;
using testing::ElementsAre;

TEST_F(Pictures, AFolderNamedLikeTheDepthsInnerOneIsNotBeforeColour) {
  file("c/rgb/1.png"), file("c/depth/data/1.png"), file("c/data/calib.yaml");
  EXPECT_THAT(read(folder_ / "c").color, ElementsAre("0 c/rgb/1.png")) << "it has no picture";
  file("v/rgb/left/1.png"), file("v/depth/left/1.png"), file("v/left/1.png");
  EXPECT_THAT(read(folder_ / "v").color, ElementsAre("0 v/rgb/left/1.png"));
  file("d/rgb/1.png"), file("d/depth/left/1.png"), file("d/left/1.png");
  EXPECT_THAT(read(folder_ / "d").color, ElementsAre("0 d/rgb/1.png"));
  file("l/depth/left/1.png"), file("l/left/1.png");
  EXPECT_THAT(read(folder_ / "l").color, ElementsAre("0 l/left/1.png")) << "there is no other";
}

TEST_F(Pictures, AFolderWithTheDepthsInnerFoldersIsNotBeforeColour) {
  file("t/rgb/1.png"), file("t/depth/left/1.png"), file("t/thermal/left/1.png");
  EXPECT_THAT(read(folder_ / "t").color, ElementsAre("0 t/rgb/1.png"));
}

TEST_F(Pictures, ANearerRecordingIsBeforeOneInADeeperFolder) {
  for (const char* kind : {"rgb", "depth"}) {
    file("a/keyframes/" + std::string(kind) + "/1.png"), file("a/old/part1/" + std::string(kind) + "/1.png");
    file("b/one/part1/" + std::string(kind) + "/1.png"), file("b/two/part1/" + std::string(kind) + "/1.png");
  }
  EXPECT_THAT(read(folder_ / "a").depth, ElementsAre("0 a/keyframes/depth/1.png"));
  EXPECT_TRUE(read(folder_ / "b").error) << "several";
  std::filesystem::remove_all(folder_ / "b/one");
  EXPECT_THAT(read(folder_ / "b").depth, ElementsAre("0 b/two/part1/depth/1.png"));
  file("b/stereo/left/1.png"), file("b/stereo/right/1.png");
  EXPECT_THAT(read(folder_ / "b").depth, ElementsAre("0 b/two/part1/depth/1.png")) << "depth is before two views";
}

// 4096 folders, of which the last one has a picture.
TEST_F(Pictures, AFolderOfVeryManyIsNotSearchedToItsEnd) {
  for (int k = 0; k < 16 * 16 * 16; ++k) {
    const auto part = [k](int shift) { return std::to_string(10 + (k >> shift & 15)) + "/"; };
    std::filesystem::create_directories(folder_ / ("m/rgb/" + part(8) + part(4) + part(0)));
  }
  file("m/rgb/25/25/25/1.png"), file("m/depth/1.png");
  EXPECT_EQ(read(folder_ / "m").streams.size(), 1U);
  file("m/rgb/10/10/10/1.png");
  EXPECT_EQ(read(folder_ / "m").streams.size(), 2U);
}

// Poses and the camera's matrix, as numbers of each picture.
TEST_F(Pictures, ASmallArrayBesideAPictureIsNotItsDepth) {
  const auto array = [](const std::string& shape) {
    std::string text = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + shape + "), }";
    text.resize(118, ' ');
    return std::string("\x93NUMPY\x01\0\x76\0", 10) + text;
  };
  for (const char* const shape : {"4, 4", "3, 3", "15, 640", "640, 15", "7,", "32, 32, 32", "32, 32, 3"}) {
    for (const char* const name : {"0001", "0002"})
      file("p/" + std::string(name) + ".jpg"), file("p/" + std::string(name) + ".npy", array(shape));
    EXPECT_EQ(read(folder_ / "p").streams.size(), 1U) << shape;
    EXPECT_EQ(read(folder_ / "p").color.front(), "0 p/0001.jpg") << shape;
  }
  for (const char* const shape : {"16, 16", "480, 640", "480, 640, 1", "1, 480, 640"}) {
    for (const char* const name : {"0001", "0002"}) file("p/" + std::string(name) + ".npy", array(shape));
    EXPECT_EQ(read(folder_ / "p").depth.size(), 2U) << shape;
  }
}

TEST(PictureRecordings, DepthAloneMayHaveWordsAsItsNames) {
  const auto recording = pictures::recordingOf({.depth = {"w/", {"beach.png", "hall.png"}}}, std::nullopt);
  ASSERT_EQ(recording.depth.size(), 2U);
  EXPECT_EQ(recording.depth[1].path, "w/hall.png");
}

TEST_F(Pictures, DepthAloneMayHaveWordsAsItsNames) {
  file("w/depth/beach.png"), file("w/depth/hall.png");
  EXPECT_THAT(read(folder_ / "w").color, ElementsAre("0 w/depth/beach.png", "33.3333 w/depth/hall.png"));
}

TEST_F(Pictures, AKnownLayoutHasItsRateFromWithin) {
  for (const char* const name : {"000000", "000001"}) file("k/image_2/" + std::string(name) + ".png");
  const std::filesystem::path before = std::filesystem::current_path();
  for (const auto& [place, url] : {std::pair{"k", "image_2"}, std::pair{"k/image_2", "."}}) {
    std::filesystem::current_path(folder_ / place);
    const std::vector<std::string> color = read(url).color;
    std::filesystem::current_path(before);
    EXPECT_THAT(color, ElementsAre("0 k/image_2/000000.png", "100 k/image_2/000001.png")) << url;
  }
}

}  // namespace
}  // namespace relievo
