// SPDX-License-Identifier: Apache-2.0
// The player's display over a picture, at 720p and 4K, in the layouts of screens: the same for both eyes to the pixel,
// legible letters of several scripts, and nothing beside the views.
#include <gtest/gtest.h>

#include "app/player/screen/screen_words.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/long_names.h"

namespace relievo::test {
namespace {

constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};

ScreenContent everything(const char* title) {
  ScreenContent content;
  content.bar = ScreenBar{.title = title,
                          .times = "1:01:23 / 1:02:05   paused",
                          .status = "3D: tab   touch: Novint Falcon, in contact",
                          .position = 0.4,
                          .buffered = 0.5,
                          .has_length = true,
                          .chapters = {0, 0.25},
                          .pointed = 0.7,
                          .pointed_time = "43:27"};
  content.forces_n[0] = 3.2;
  content.notice = ScreenNotice{"Volume 80 %", 0.6};
  content.warning = "haptic device lost";
  return content;
}

// A rectangle from the top left.
struct Part {
  int x, y, width, height;
};

struct View {
  StereoLayout layout;
  int width, height;
  Part left, right;
};

class RenderDisplay : public testing::TestWithParam<View> {
 protected:
  static Image drawn(Stage& stage, const ScreenContent& content) {
    const View& view = GetParam();
    ScreenWords words;
    const TextFrame frame{.width = view.left.width, .height = view.left.height, .aspect = 16.0 / 9};
    if (!words.draw(content, frame)) return {};
    stage.renderer().setText(frame, words.pictures());
    return stage.show({.color = makeRgbFrame(32, 18, [](int, int) { return Rgb{0, 40, 0}; }),
                       .volume = kVolume,
                       .stereo = {.layout = view.layout, .strength = 2, .screen_z_mm = 5}});
  }
  static int inkIn(const Image& image, const Part& part) {
    int ink = 0;
    for (int y = part.y; y < part.y + part.height; ++y) {
      for (int x = part.x; x < part.x + part.width; ++x) ink += image.channel(x, y, 0) > 128 ? 1 : 0;
    }
    return ink;
  }
};

TEST_P(RenderDisplay, IsTheSameForBothEyes) {
  const View& view = GetParam();
  STAGE_OR_SKIP(stage, view.width, view.height);
  if (!AssText::create()) GTEST_SKIP() << "no font here";
  for (const char* title : {kLongName, kJapaneseName, kArabicName}) {
    const Image image = drawn(stage, everything(title));
    ASSERT_EQ(image.width, view.width);
    int different = 0;
    for (int y = 0; y < view.left.height; ++y) {
      for (int x = 0; x < view.left.width; ++x) {
        const Rgb left = image.at(view.left.x + x, view.left.y + y),
                  right = image.at(view.right.x + x, view.right.y + y);
        different += left == right ? 0 : 1;
      }
    }
    EXPECT_EQ(different, 0) << title;
    // Two lines of 30 units and one of 24, in a fifth of the view: letters are a few hundredths of it.
    const Part foot{view.left.x, view.left.y + view.left.height * 540 / 720, view.left.width, view.left.height / 7};
    const double share = static_cast<double>(inkIn(image, foot)) / (foot.width * foot.height);
    EXPECT_GT(share, 0.02) << title;
    EXPECT_LT(share, 0.3) << title;
  }
}

TEST_P(RenderDisplay, LeavesTheGapBetweenTheEyesBlack) {
  const View& view = GetParam();
  if (view.layout != StereoLayout::FramePacking) GTEST_SKIP() << "without a gap";
  STAGE_OR_SKIP(stage, view.width, view.height);
  const Image image = drawn(stage, everything(kLongName));
  ASSERT_EQ(image.width, view.width);
  for (int y = view.left.height; y < view.right.y; ++y) {
    for (int x = 0; x < view.width; ++x) ASSERT_EQ(image.at(x, y), (Rgb{0, 0, 0})) << x << " " << y;
  }
}

// HDMI 1.4a: 1280 x 720 with 30 rows between the eyes, 1920 x 1080 with 45.
INSTANTIATE_TEST_SUITE_P(
    Views, RenderDisplay,
    testing::Values(View{StereoLayout::Mono, 1280, 720, {0, 0, 1280, 720}, {0, 0, 1280, 720}},
                    View{StereoLayout::SideBySide, 1280, 720, {0, 0, 640, 720}, {640, 0, 640, 720}},
                    View{StereoLayout::TopBottom, 1280, 720, {0, 0, 1280, 360}, {0, 360, 1280, 360}},
                    View{StereoLayout::FramePacking, 1280, 1470, {0, 0, 1280, 720}, {0, 750, 1280, 720}},
                    View{StereoLayout::FramePacking, 1920, 2205, {0, 0, 1920, 1080}, {0, 1125, 1920, 1080}},
                    View{StereoLayout::SideBySide, 3840, 2160, {0, 0, 1920, 2160}, {1920, 0, 1920, 2160}},
                    View{StereoLayout::TopBottom, 3840, 2160, {0, 0, 3840, 1080}, {0, 1080, 3840, 1080}}));

}  // namespace
}  // namespace relievo::test
