// SPDX-License-Identifier: Apache-2.0
// What names of pictures and folders say: colour, depth or something else, and what two pictures of one moment share.
#include "drivers/pictures/roles.h"

#include <gtest/gtest.h>

namespace relievo::pictures {
namespace {

TEST(PictureRoles, JoinedWordsSayWhatTheirPartsSay) {
  for (const char* name : {"depthImage0.png", "KinectDepth0.png", "DepthFrame3.png", "DepthImages", "depthimages",
                           "depthframes", "RawDepth", "depthmaps", "DepthMap", "img_DepthPlanar_0.pfm"}) {
    EXPECT_EQ(roleOf(name), Role::Depth) << name;
  }
  for (const char* name :
       {"colorImage0.png", "KinectColor0.png", "ColorFrame3.png", "RGBFrames", "rgbimages", "LeftRgb"}) {
    EXPECT_EQ(roleOf(name), Role::Color) << name;
  }
  for (const char* name : {"MaskImages", "segmentationimages", "DepthMask", "InfraredFrame2.png"}) {
    EXPECT_EQ(roleOf(name), Role::Other) << name;
  }
  for (const char* name : {"keyframe7.png", "0_colormap.png", "Bedroom", "frames", "scene_01"}) {
    EXPECT_EQ(roleOf(name), Role::Unsaid) << name;
  }
}

TEST(PictureRoles, PicturesOfOneMomentShareTheirKey) {
  EXPECT_EQ(keyOf("colorImage0.jpg"), keyOf("depthImage0.png"));
  EXPECT_EQ(keyOf("KinectColor12.jpg"), keyOf("KinectDepth12.png"));
  EXPECT_EQ(keyOf("rgbframe2.jpg"), keyOf("depthframe2.png"));
  EXPECT_EQ(keyOf("cat-image.jpg"), keyOf("cat-depth.png"));
  EXPECT_NE(keyOf("KinectColor12.jpg"), keyOf("KinectDepth13.png"));
  EXPECT_NE(keyOf("beach.jpg"), keyOf("beach_sunset.png"));
}

}  // namespace
}  // namespace relievo::pictures
