// SPDX-License-Identifier: Apache-2.0
#include "hal/media/media_names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace relievo {
namespace {

// By the code points of UTF-8, also where a char has a sign.
TEST(NaturalOrder, NumbersCountAndOtherScriptsComeLast) {
  std::vector<std::string> names{"فيلم", "10.png", "z.mkv", "2.png", "映画", "é.mkv", "A.mkv"};
  std::ranges::sort(names, naturalLess);
  EXPECT_EQ(names, (std::vector<std::string>{"2.png", "10.png", "A.mkv", "z.mkv", "é.mkv", "فيلم", "映画"}));
}

TEST(Names, OfPhotosEndAsACamerasDo) {
  for (const char* name : {"IMG_1.JPG", "a/b.jpeg", "c.heic", "d.MPO"}) EXPECT_TRUE(isPhotoName(name)) << name;
  for (const char* name : {"IMG_1.png", "jpg", "a.jpg.npy", "c.mp4"}) EXPECT_FALSE(isPhotoName(name)) << name;
}

TEST(Names, SayDepthByAWord) {
  for (const char* name : {"clip_depth.mp4", "/a/Depth.mkv", "depth-2.webm", "depths.mkv", "a-DISP.png"})
    EXPECT_TRUE(saysDepth(name)) << name;
  for (const char* name : {"clip.mp4", "depth/1.png", "outdepth.mkv", "display.mp4", "1.depth",
                           "The Lower Depths (1936).mkv", "The.Lower.Depths.mkv"})
    EXPECT_FALSE(saysDepth(name)) << name;
}

}  // namespace
}  // namespace relievo
