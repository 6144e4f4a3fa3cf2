// SPDX-License-Identifier: Apache-2.0
// Where a hand without eyes is told to begin.
#include "app/haptics/touch_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/support/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};

// Code 0 is a hole; `is_surface` tells it by scene mm.
template <class IsSurface>
std::optional<glm::dvec2> placeOn(IsSurface&& is_surface) {
  const GridMapping grid(kVolume, 160, 108);
  const Frame frame = test::makeGrayFrame(160, 108, 8, MediaTime{},
                                          [&](int c, int r) { return is_surface(grid.x(c), grid.y(r)) ? 100 : 0; });
  return placeToTouch(HeightField::make(frame, {.invalid_code = 0}, kVolume).value());
}

TEST(PlaceToTouch, IsTheMiddleWhereTheMiddleIsThere) {
  EXPECT_EQ(placeOn([](double, double) { return true; }), glm::dvec2(0, 0));
  EXPECT_EQ(placeOn([](double x, double y) { return std::hypot(x, y) < 6; }), glm::dvec2(0, 0));
}

TEST(PlaceToTouch, IsBesideAHoleByAFingertip) {
  const auto place = placeOn([](double x, double y) { return std::hypot(x, y) > 25; });
  ASSERT_TRUE(place);
  // The fingertip, of 4 mm, is clear of the hole; and no place of the lattice, of 4 mm, is nearer.
  EXPECT_GE(glm::length(*place), 29 - 1);
  EXPECT_LE(glm::length(*place), 29 + 4);
}

TEST(PlaceToTouch, PassesOverSpecksAndTheBorder) {
  // A speck in the middle, a strip at the left border, and a blob.
  const auto place =
      placeOn([](double x, double y) { return std::hypot(x, y) < 3 || x < -76 || std::hypot(x - 40, y + 20) < 10; });
  ASSERT_TRUE(place);
  EXPECT_LT(glm::distance(*place, glm::dvec2(40, -20)), 6.5);
}

TEST(PlaceToTouch, IsNowhereWhereNothingIs) {
  EXPECT_FALSE(placeOn([](double, double) { return false; }));
  EXPECT_FALSE(placeOn([](double x, double) { return std::fmod(std::abs(x), 8.0) < 4; }));  // too narrow for a finger
}

}  // namespace
}  // namespace relievo
