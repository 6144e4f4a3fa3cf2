// SPDX-License-Identifier: Apache-2.0
// What a mouse over a window points at, in every layout: the point that the cameras draw under it.
#include <gtest/gtest.h>

#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "app/render/relief/stereo.h"
#include "drivers/window/scene_ray.h"

namespace relievo {
namespace {

struct Surface {
  int width, height;
};

// The share of the surface, from its top left, where this view draws a point.
glm::dvec2 shareOf(const EyeView& view, const glm::dvec3& point_mm, const Surface& surface) {
  const glm::dvec4 clip = view.view_projection * glm::dvec4(point_mm, 1);
  const double across = view.area.x + view.area.width * (0.5 + 0.5 * clip.x / clip.w);
  const double up = view.area.y + view.area.height * (0.5 + 0.5 * clip.y / clip.w);
  return {across / surface.width, 1 - up / surface.height};
}

void expectUnderTheMouse(const StereoSettings& settings, const DisplayVolume& volume, const Surface& surface) {
  const SceneViews views = sceneViews(settings, volume, surface.width, surface.height);
  const EyeViews eyes = eyeViews(settings, volume, surface.width, surface.height);
  for (const glm::dvec3& point :
       {glm::dvec3(0, 0, 20), glm::dvec3(-60, 30, 40), glm::dvec3(55, -35, 0), glm::dvec3(10, 5, 33)}) {
    std::vector<glm::dvec2> places;
    for (const EyeView& view : eyes.views) places.push_back(shareOf(view, point, surface));
    if (eyes.mixed) places = {0.5 * (places[0] + places[1])};  // the finger is between its two images
    for (const glm::dvec2& place : places) {
      const auto ray = rayThrough(views, place.x, place.y);
      ASSERT_TRUE(ray);
      EXPECT_NEAR(ray->at(point.z).x, point.x, 1e-6);
      EXPECT_NEAR(ray->at(point.z).y, point.y, 1e-6);
    }
  }
}

class EveryLayout : public testing::TestWithParam<int> {};

TEST_P(EveryLayout, TheMouseIsWhereTheFingerIsDrawn) {
  const auto layout = static_cast<StereoLayout>(GetParam());
  const bool packing = layout == StereoLayout::FramePacking;
  const std::vector<Surface> surfaces = packing
                                            ? std::vector<Surface>{{1920, 2205}, {1280, 1470}}
                                            : std::vector<Surface>{{1280, 720}, {641, 479}, {500, 900}, {1600, 400}};
  for (const Surface& surface : surfaces) {
    for (const DisplayVolume& volume :
         {DisplayVolume{160, 90, 40}, DisplayVolume{160, 120, 40}, DisplayVolume{160, 284, 100}}) {
      for (const bool swapped : {false, true}) {
        SCOPED_TRACE(std::string(name(layout)) + " " + std::to_string(surface.width) + "x" +
                     std::to_string(surface.height));
        StereoSettings settings{.layout = layout, .quilt_cols = 5, .quilt_rows = 3, .swap_eyes = swapped};
        expectUnderTheMouse(settings, volume, surface);
        settings.full = true;
        settings.strength = 0.4;
        settings.screen_z_mm = 7;
        expectUnderTheMouse(settings, volume, surface);
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(All, EveryLayout, testing::Range(0, kStereoLayouts), [](const auto& each) {
  std::string word = name(static_cast<StereoLayout>(each.param));
  std::erase(word, '-');
  return word;
});

TEST(SceneRay, InTheGapBetweenTheEyesThereIsNothingToPointAt) {
  const SceneViews views = sceneViews({.layout = StereoLayout::FramePacking}, DisplayVolume{160, 90, 40}, 1920, 2205);
  EXPECT_TRUE(rayThrough(views, 0.5, 1079.5 / 2205));
  EXPECT_FALSE(rayThrough(views, 0.5, 1100.5 / 2205));
  EXPECT_TRUE(rayThrough(views, 0.5, 1125.5 / 2205));
  EXPECT_FALSE(rayThrough({}, 0.5, 0.5));
}

}  // namespace
}  // namespace relievo
