// SPDX-License-Identifier: Apache-2.0
// Names of films that are hard to show, over the views of both eyes.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/render/relief/stereo.h"
#include "app/render/text/ass_text.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/long_names.h"

namespace relievo::test {
namespace {

constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};

std::vector<TextPicture> drawn(AssText& text, const TextFrame& frame, const std::string& name) {
  text.begin("[Script Info]\nPlayResX: 1280\nPlayResY: 720\nWrapStyle: 0\n");
  text.add("0,0,Default,,0,0,0,,{\\an1\\pos(40,690)\\fs40}" + name, Duration(0), std::chrono::seconds(9));
  std::vector<TextPicture> pictures;
  text.draw(frame, Duration(0), pictures);
  return pictures;
}

// Where each eye has a view of its own.
TEST(RenderNames, AreTheSameInBothViews) {
  auto made = AssText::create();
  if (!made) GTEST_SKIP() << made.error().message;
  using enum StereoLayout;
  const struct {
    StereoLayout layout;
    int width, height;
  } surfaces[] = {{SideBySide, 1280, 720},    {TopBottom, 1280, 720},   {FramePacking, 1280, 1470},
                  {FramePacking, 1920, 2205}, {SideBySide, 3840, 2160}, {TopBottom, 3840, 2160}};
  for (const auto& [layout, width, height] : surfaces) {
    STAGE_OR_SKIP(stage, width, height);
    const StereoSettings stereo{.layout = layout, .strength = 2, .screen_z_mm = 5};
    const EyeViews eyes = eyeViews(stereo, kVolume, width, height);
    const PixelArea a = eyes.views[0].area, b = eyes.views[1].area;
    const Scene black{
        .color = makeRgbFrame(32, 18, [](int, int) { return Rgb{0, 0, 0}; }), .volume = kVolume, .stereo = stereo};
    const TextFrame view{.width = a.width, .height = a.height, .aspect = eyes.aspect};
    for (const char* said : {kLongName, kJapaneseName, kArabicName}) {
      SCOPED_TRACE(std::string(name(layout)) + " " + std::to_string(height) + " " + said);
      stage.renderer().setText(view, drawn(*made, view, said));
      const Image image = stage.show(black);
      int ink = 0, differs = 0;
      for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
          const int left = image.channel(a.x + x, height - a.y - a.height + y, 1);
          ink += left > 128 ? 1 : 0;
          differs += left == image.channel(b.x + x, height - b.y - b.height + y, 1) ? 0 : 1;
        }
      }
      EXPECT_GT(ink, a.width);
      EXPECT_EQ(differs, 0);
    }
  }
}

}  // namespace
}  // namespace relievo::test
