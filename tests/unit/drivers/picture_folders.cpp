// SPDX-License-Identifier: Apache-2.0
// Which folders of a recording are taken for its colour and its depth, and how far they are looked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/drivers/picture_files.h"

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
}

}  // namespace
}  // namespace relievo
