// SPDX-License-Identifier: Apache-2.0
// The finger's sphere is at its position, in front of or behind the relief; its arrow is as long as the force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/golden/picture_stage.h"

namespace relievo::test {
namespace {

// 1280 x 720 pixels for 160 x 90 mm: 8 pixels a mm.
constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};
constexpr double kPixelsPerMm = 8.0;
constexpr double kEyes = 63.0, kDistance = 600.0, kScreenZ = 20.0;

// A black plane at one height.
Scene blackPlane(double z, const FingerMark& finger) {
  return {.color = makeRgbFrame(16, 9, [](int, int) { return Rgb{0, 0, 0}; }),
          .depth = makePlane(32, 18, 16, static_cast<std::uint32_t>(z / kVolume.depth_mm * 65535.0)),
          .calibration = {.bits = 16},
          .volume = kVolume,
          .finger = finger};
}

struct Box {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
  [[nodiscard]] double x() const { return 0.5 * (left + right + 1); }
  [[nodiscard]] double y() const { return 0.5 * (top + bottom + 1); }
  [[nodiscard]] double width() const { return right + 1 - left; }
};

// The bounding box of everything not black between two columns.
Box litBox(const Image& image, int x0, int x1) {
  Box box;
  for (int y = 0; y < image.height; ++y) {
    for (int x = x0; x < x1; ++x) {
      if (image.at(x, y) == Rgb{0, 0, 0}) continue;
      box = {std::min(box.left, x), std::max(box.right, x), std::min(box.top, y), std::max(box.bottom, y)};
    }
  }
  return box;
}

double onScreen(double eye_x, double x, double z) {
  return eye_x + (x - eye_x) * kDistance / (kDistance - (z - kScreenZ));
}

TEST(RenderFinger, SphereIsWhereItsPositionProjects) {
  STAGE_OR_SKIP(stage, 1280, 720);
  for (const glm::dvec3& p : {glm::dvec3(0, 0, 20), glm::dvec3(50, -20, 38), glm::dvec3(-60, 30, 5)}) {
    const Box box = litBox(stage.show(blackPlane(0, {.position_mm = p})), 0, 1280);
    EXPECT_NEAR(box.x(), 640 + kPixelsPerMm * onScreen(0, p.x, p.z), 0.75) << p.x;
    EXPECT_NEAR(box.y(), 360 - kPixelsPerMm * onScreen(0, p.y, p.z), 0.75) << p.x;
    EXPECT_NEAR(box.width(), kPixelsPerMm * 5.0 * kDistance / (kDistance - (p.z - kScreenZ)), 1.5);
  }
}

TEST(RenderFinger, EachEyeSeesTheSphereFromItsSide) {
  STAGE_OR_SKIP(stage, 1280, 720);
  Scene scene = blackPlane(0, {.position_mm = {10, 5, 36}});
  scene.stereo.layout = StereoLayout::SideBySide;
  const Image image = stage.show(scene);
  const Box left = litBox(image, 0, 640);
  const Box right = litBox(image, 640, 1280);
  EXPECT_NEAR(left.x(), 320 + 4 * onScreen(-kEyes / 2, 10, 36), 0.75);
  EXPECT_NEAR(right.x(), 960 + 4 * onScreen(kEyes / 2, 10, 36), 0.75);
  EXPECT_EQ(left.top, right.top);
  EXPECT_EQ(left.bottom, right.bottom);
}

TEST(RenderFinger, ArrowGrowsByFiveMillimetresANewton) {
  STAGE_OR_SKIP(stage, 1280, 720);
  const glm::dvec3 here(-20, 0, 20);  // in the screen plane: 8 pixels a mm
  for (const double force : {1.0, 3.0, 8.0}) {
    const Box right = litBox(stage.show(blackPlane(0, {.position_mm = here, .force_n = {force, 0, 0}})), 0, 1280);
    EXPECT_NEAR(right.right + 1, 640 + kPixelsPerMm * (here.x + 2.5 + 5.0 * force), 2.0);
    EXPECT_NEAR(right.left, 640 + kPixelsPerMm * (here.x - 2.5), 1.0);
    const Box up = litBox(stage.show(blackPlane(0, {.position_mm = here, .force_n = {0, force, 0}})), 0, 1280);
    EXPECT_NEAR(up.top, 360 - kPixelsPerMm * (2.5 + 5.0 * force), 2.0);
    EXPECT_NEAR(up.bottom + 1, 360 + kPixelsPerMm * 2.5, 1.0);
  }
}

TEST(RenderFinger, NoForceIsNoArrow) {
  STAGE_OR_SKIP(stage, 1280, 720);
  const Box box = litBox(stage.show(blackPlane(0, {.position_mm = {0, 0, 20}})), 0, 1280);
  EXPECT_NEAR(box.width(), 40, 1.5);
}

double light(const Rgb& rgb) {
  return rgb[0] + rgb[1] + rgb[2];
}

TEST(RenderFinger, ContactIsBrighter) {
  STAGE_OR_SKIP(stage, 1280, 720);
  FingerMark mark{.position_mm = {0, 0, 20}};
  const Image free = stage.show(blackPlane(0, mark));
  mark.contact = true;
  const Image touching = stage.show(blackPlane(0, mark));
  EXPECT_GT(touching.channel(640, 355, 0), free.channel(640, 355, 0) + 60);
  EXPECT_GT(light(free.at(640, 355)), 200);
}

TEST(RenderFinger, HiddenFingerShowsFaintly) {
  STAGE_OR_SKIP(stage, 1280, 720);
  const FingerMark mark{.position_mm = {0, 0, 20}};
  const double before = light(stage.show(blackPlane(0, mark)).at(640, 360));
  const double behind = light(stage.show(blackPlane(40, mark)).at(640, 360));
  EXPECT_GT(behind, 0.15 * before);
  EXPECT_LT(behind, 0.45 * before);
}

TEST(RenderFinger, HalfSunkSphereIsSolidAboveTheSurfaceAndFaintBelow) {
  // The surface slopes through the sphere's centre: z = 20 + x. The sphere's left half is in front of the surface, its
  // right half behind it.
  STAGE_OR_SKIP(stage, 1280, 720);
  Scene scene = blackPlane(0, {.position_mm = {0, 0, 20}, .contact = true});
  // Two samples 80 mm apart: 0 at x = -40 and 40 at x = 40 would be a slope of a half.
  Frame slope = makePlane(2, 18, 16, 0);
  auto words = std::make_shared<std::vector<std::uint16_t>>(2 * 18);
  for (std::size_t i = 0; i < words->size(); ++i) (*words)[i] = i % 2 == 0 ? 0 : 65535;
  slope.planes[0].data = reinterpret_cast<const std::uint8_t*>(words->data());
  slope.owner = words;
  scene.depth = slope;
  const Image image = stage.show(scene);
  // At 2.2 mm to the left the sphere's front is at 20 + 1.19, the slope at 18.9; to the right 21.19 and 21.1: at the
  // rim at 2.4 it is 20.7 against 21.2.
  EXPECT_GT(light(image.at(640 - 19, 360)), 200);
  EXPECT_LT(light(image.at(640 + 19, 360)), 0.5 * light(image.at(640 - 19, 360)));
  EXPECT_GT(light(image.at(640 + 19, 360)), 0);
}

// A white plane, 20 mm high; the darkest spot is the shadow, with the finger excluded by its colour.
Spot shadow(const Image& image) {
  Spot spot;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Rgb rgb = image.at(x, y);
      if (rgb[0] != rgb[2]) continue;  // the finger is yellow
      const double dark = 1 - rgb[0] / 255.0;
      spot.x += dark * x;
      spot.y += dark * y;
      spot.weight += dark;
    }
  }
  spot.x /= spot.weight;
  spot.y /= spot.weight;
  return spot;
}

TEST(RenderFinger, ShadowMovesAwayAndFadesWithTheHeightOverTheSurface) {
  STAGE_OR_SKIP(stage, 1280, 720);
  Scene scene = blackPlane(20, {});
  scene.color = makeRgbFrame(32, 18, [](int, int) { return Rgb{255, 255, 255}; });
  double x = 0, y = 0, deepest = 256;
  for (const double height : {8.0, 16.0, 30.0}) {
    scene.finger = FingerMark{.position_mm = {0, 0, 20 + height}};
    const Image image = stage.show(scene);
    const Spot at = shadow(image);
    // To the lower right by 0.35 of the height, at 8 pixels per mm.
    EXPECT_GT(at.x, 640 + 8 * 0.25 * height);
    EXPECT_GT(at.x, x);
    EXPECT_GT(at.y, y);
    const int dark = 255 - image.channel(static_cast<int>(at.x), static_cast<int>(at.y), 0);
    EXPECT_LT(dark, deepest);
    EXPECT_GT(dark, 20);
    x = at.x;
    y = at.y;
    deepest = dark;
  }
}

TEST(RenderFinger, ContactGlowsOnTheSurfaceTheMoreTheHarder) {
  STAGE_OR_SKIP(stage, 1280, 720);
  const auto glow = [&](bool contact, double force) {
    const FingerMark mark{.position_mm = {0, 0, 20}, .force_n = {0, 0, force}, .contact = contact};
    const Image image = stage.show(blackPlane(20, mark));
    return image.channel(640 - 32, 360, 0);  // 4 mm from the middle, outside the sphere
  };
  EXPECT_EQ(glow(false, 0), 0);
  EXPECT_GT(glow(true, 0), 20);
  EXPECT_GT(glow(true, 4), glow(true, 0) + 20);
}

// The first finger on the left, the second on the right, or the second alone.
TEST(RenderFinger, TheSecondOneIsAsLargeAndBlueWhereTheFirstIsAmber) {
  STAGE_OR_SKIP(stage, 1280, 720);
  Scene scene = blackPlane(20, {.position_mm = {-30, 0, 20}, .contact = true});
  scene.second_finger = FingerMark{.position_mm = {30, 0, 20}, .force_n = {0, 2, 0}, .contact = true};
  const Image both = stage.show(scene);
  const int first_x = 640 - 30 * 8, second_x = 640 + 30 * 8;
  EXPECT_GT(both.channel(first_x, 355, 0), both.channel(first_x, 355, 2) + 100);
  EXPECT_GT(both.channel(second_x, 355, 2), both.channel(second_x, 355, 0) + 100);
  EXPECT_GT(both.channel(first_x - 32, 360, 0), both.channel(first_x - 32, 360, 2)) << "its glow";
  EXPECT_GT(both.channel(second_x - 32, 360, 2), both.channel(second_x - 32, 360, 0)) << "its glow";
  EXPECT_NEAR(litBox(both, 640, 1280).top, 360 - kPixelsPerMm * (2.5 + 5.0 * 2), 2.0) << "its arrow";
  scene.finger.reset();
  const Image alone = stage.show(scene);
  EXPECT_EQ(litBox(alone, 0, 640).right, -1);
  EXPECT_EQ(alone.at(second_x, 355), both.at(second_x, 355));
}

TEST(RenderFinger, GoesWhenThereIsNone) {
  STAGE_OR_SKIP(stage, 320, 180);
  Scene scene = blackPlane(0, {.position_mm = {0, 0, 20}});
  EXPECT_GT(litBox(stage.show(scene), 0, 320).width(), 0);
  scene.finger.reset();
  EXPECT_EQ(litBox(stage.show(scene), 0, 320).right, -1);
}

}  // namespace
}  // namespace relievo::test
