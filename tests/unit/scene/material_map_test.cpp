// SPDX-License-Identifier: Apache-2.0
// A material track's picture read at places of the scene.
#include "app/scene/material_map.h"

#include <gtest/gtest.h>

#include "tests/support/film/material_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 120, 40};

// 16 x 12 samples are 10 mm each, the chroma's 20 mm.
TEST(MaterialMap, ReadsEachPlaneAtItsOwnSamples) {
  const auto map = test::materialOf(16, 12, kVolume, [](double x, double y) {
    return test::MaterialCodes{static_cast<std::uint8_t>(100 + x), static_cast<std::uint8_t>(100 + y),
                               static_cast<std::uint8_t>(100 - x)};
  });
  for (const double x : {-35.0, 5.0, 45.0}) {
    EXPECT_NEAR(map->at(x, 15).stiffness, (100 + x) / 255, 1e-9);
  }
  EXPECT_NEAR(map->at(0, 10).friction, 110.0 / 255, 1e-9);
  EXPECT_NEAR(map->at(-30, 10).texture, 130.0 / 255, 1e-9);
  EXPECT_NEAR(map->at(8, 0).stiffness, 108.0 / 255, 1e-9) << "linear between samples";
  EXPECT_NEAR(map->at(0, 4).friction, 104.0 / 255, 1e-9);
  EXPECT_NEAR(map->at(500, 0).stiffness, 175.0 / 255, 1e-9) << "the last sample goes on";
  EXPECT_NEAR(map->at(-500, 900).friction, 150.0 / 255, 1e-9);
}

TEST(MaterialMap, LimitedCodesReachFromNoneToFull) {
  Frame frame = test::makeMaterialFrame(16, 12, kVolume, {}, [](double x, double) {
    return x < 0 ? test::MaterialCodes{16, 16, 240} : test::MaterialCodes{235, 128, 255};
  });
  frame.range = ColorRange::Limited;
  const auto map = MaterialMap::make(frame, kVolume);
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(map->at(-40, 0).stiffness, 0);
  EXPECT_EQ(map->at(40, 0).stiffness, 1);
  EXPECT_EQ(map->at(-40, 0).texture, 1);
  EXPECT_NEAR(map->at(40, 0).friction, 0.5, 1e-9);
  EXPECT_EQ(map->at(40, 0).texture, 1) << "beyond the range";
}

TEST(MaterialMap, RefusesPicturesOfOtherKinds) {
  Frame frame = test::makeMaterialFrame(16, 12, kVolume, {}, [](double, double) { return test::MaterialCodes{}; });
  frame.model = ColorModel::Gray;
  EXPECT_FALSE(MaterialMap::make(frame, kVolume).has_value());
  frame.model = ColorModel::Yuv;
  frame.components[1].bits = 10;
  EXPECT_FALSE(MaterialMap::make(frame, kVolume).has_value());
}

}  // namespace
}  // namespace relievo
