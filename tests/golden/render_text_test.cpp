// SPDX-License-Identifier: Apache-2.0
// Text on the picture: its position for each eye, and that it is legible ink.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/render/gl/glyphs.h"
#include "tests/golden/picture_stage.h"

namespace relievo::test {
namespace {

constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};

Scene blackScene(const StereoSettings& stereo) {
  return {.color = makeRgbFrame(32, 18, [](int, int) { return Rgb{0, 0, 0}; }), .volume = kVolume, .stereo = stereo};
}

TEST(RenderText, StandsInTheScreenPlaneForBothEyes) {
  STAGE_OR_SKIP(stage, 1280, 720);
  stage.renderer().setText({"what is going on", "and why"});
  for (const double screen_z : {20.0, 5.0}) {
    const Image image =
        stage.show(blackScene({.layout = StereoLayout::SideBySide, .strength = 2, .screen_z_mm = screen_z}));
    const Spot left = image.centroid(1, 0, 640), right = image.centroid(1, 640, 1280);
    EXPECT_GT(left.weight, 100);
    EXPECT_NEAR(left.x, right.x - 640, 0.05);
    EXPECT_NEAR(left.y, right.y, 0.05);
    EXPECT_LT(left.x, 320) << "at the left";
    EXPECT_GT(left.y, 600) << "at the foot";
  }
}

TEST(RenderText, StaysInsideThePictureHoweverLongItIs) {
  STAGE_OR_SKIP(stage, 640, 360);
  stage.renderer().setText({std::string(400, 'M')});
  const Image image = stage.show(blackScene({.layout = StereoLayout::Mono}));
  EXPECT_GT(image.centroid(0, 0, 640).weight, 10);
  EXPECT_EQ(image.centroid(0, 0, 8).weight, 0);
  EXPECT_EQ(image.centroid(0, 632, 640).weight, 0);
}

TEST(RenderText, GoesWithoutATrace) {
  STAGE_OR_SKIP(stage, 640, 360);
  const Scene scene = blackScene({.layout = StereoLayout::Mono});
  stage.renderer().setText({"here"});
  EXPECT_GT(stage.show(scene).centroid(0, 0, 640).weight, 10);
  stage.renderer().setText({});
  EXPECT_EQ(stage.show(scene).centroid(0, 0, 640).weight, 0);
}

int inkOf(const InkPicture& picture) {
  int ink = 0;
  for (const auto value : picture.ink) ink += value > 128;
  return ink;
}

TEST(Glyphs, LettersAreLetters) {
  auto glyphs = Glyphs::create(40);
  if (!glyphs) GTEST_SKIP() << glyphs.error().message;
  const InkPicture one = glyphs->draw({"l"}), wide = glyphs->draw({"M"}), two = glyphs->draw({"l", "M"});
  EXPECT_EQ(one.height, 40);
  EXPECT_EQ(two.height, 80);
  EXPECT_EQ(two.width, wide.width);
  EXPECT_GT(wide.width, one.width);
  EXPECT_GT(inkOf(one), 20);
  EXPECT_EQ(inkOf(two), inkOf(one) + inkOf(wide));
  EXPECT_EQ(inkOf(glyphs->draw({" "})), 0);
}

TEST(Glyphs, CharactersOfSeveralBytesAreOneGlyphEach) {
  auto glyphs = Glyphs::create(40);
  if (!glyphs) GTEST_SKIP() << glyphs.error().message;
  EXPECT_EQ(glyphs->draw({"\xc3\xa9"}).width, glyphs->draw({"e"}).width);  // e acute
  EXPECT_GT(inkOf(glyphs->draw({"\xc3\xa9"})), inkOf(glyphs->draw({"e"})));
  // Invalid UTF-8 neither ends the line nor causes a read past it.
  for (const char* broken : {"\xff", "\xc3", "a\xe2\x82", "\xc3g"})
    EXPECT_GT(inkOf(glyphs->draw({broken})), 20) << broken;
}

}  // namespace
}  // namespace relievo::test
