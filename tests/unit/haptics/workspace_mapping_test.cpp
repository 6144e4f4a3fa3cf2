// SPDX-License-Identifier: Apache-2.0
// The finger's position in the scene, for devices with different workspaces.
#include "app/haptics/task/workspace_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 90, 40};
constexpr std::uint32_t kClutch = WorkspaceMapping::kClutchButton;

HapticCapabilities workspace(const glm::dvec3& min_mm, const glm::dvec3& max_mm) {
  return {.name = "test", .workspace_min_mm = min_mm, .workspace_max_mm = max_mm};
}

TEST(WorkspaceMapping, ADeviceThatIsLargeEnoughIsAsItIs) {
  WorkspaceMapping mapping(workspace({-100, -80, -40}, {100, 80, 80}), kVolume);
  EXPECT_EQ(mapping.scale(), 1);
  EXPECT_EQ(mapping.follow({{10, -20, 30}, 0}).hip_mm, glm::dvec3(10, -20, 30));
}

TEST(WorkspaceMapping, ASmallOneReachesThePicturesCornersBeforeItsSoftEdges) {
  // The Falcon: 100 mm each way, 92 of them free; its z is 75 to 175.
  WorkspaceMapping mapping(workspace({-50, -50, 75}, {50, 50, 175}), kVolume);
  EXPECT_DOUBLE_EQ(mapping.scale(), 160.0 / 92);
  const auto corner = mapping.follow({{46, 46 * 90 / 160.0, 125}, 0});
  EXPECT_NEAR(corner.hip_mm.x, 80, 1e-9);
  EXPECT_NEAR(corner.hip_mm.y, 45, 1e-9);
  EXPECT_NEAR(corner.hip_mm.z, 20, 1e-9) << "the middle of one is the middle of the other";
  EXPECT_EQ(corner.edge_force_n, glm::dvec3(0));
  EXPECT_NEAR(glm::distance(mapping.deviceAt(corner.hip_mm), {46, 25.875, 125}), 0, 1e-9);
}

TEST(WorkspaceMapping, AFlatOneReachesTheWholeDepth) {
  // 20 mm deep, 12 of them free.
  WorkspaceMapping mapping(workspace({-100, -100, -10}, {100, 100, 10}), kVolume);
  EXPECT_DOUBLE_EQ(mapping.scale(), 40.0 / 12);
  EXPECT_NEAR(mapping.follow({{0, 0, -6}, 0}).hip_mm.z, 0, 1e-9);
  EXPECT_NEAR(mapping.follow({{0, 0, 6}, 0}).hip_mm.z, 40, 1e-9);
}

TEST(WorkspaceMapping, TheClutchHoldsTheFingerWhileTheDeviceMoves) {
  WorkspaceMapping mapping(workspace({-50, -50, 75}, {50, 50, 175}), kVolume);
  const glm::dvec3 before = mapping.follow({{40, 0, 125}, 0}).hip_mm;
  for (double x = 40; x >= -20; x -= 1) {
    const auto held = mapping.follow({{x, 0, 125}, kClutch});
    ASSERT_TRUE(held.clutched);
    ASSERT_NEAR(glm::distance(held.hip_mm, before), 0, 1e-9);
  }
  const auto after = mapping.follow({{-20, 0, 125}, 0});
  EXPECT_FALSE(after.clutched);
  EXPECT_NEAR(glm::distance(after.hip_mm, before), 0, 1e-9) << "no jump when the clutch is released";
  EXPECT_NEAR(mapping.follow({{-10, 0, 125}, 0}).hip_mm.x - before.x, 10 * mapping.scale(), 1e-9);
  EXPECT_NEAR(mapping.deviceAt(mapping.follow({{5, 6, 99}, 0}).hip_mm).y, 6, 1e-9);
}

TEST(WorkspaceMapping, APositionThatIsNoneIsForgottenWhileTheClutchIsHeldToo) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    WorkspaceMapping mapping(workspace({-100, -80, -40}, {100, 80, 80}), kVolume);
    static_cast<void>(mapping.follow({{10, 0, 20}, 0}));
    EXPECT_FALSE(std::isfinite(mapping.follow({{10, bad, 20}, kClutch}).hip_mm.y));
    EXPECT_EQ(mapping.follow({{10, 0, 20}, kClutch}).hip_mm, glm::dvec3(10, 0, 20));
    EXPECT_TRUE(mapping.follow({{10, bad, 20}, kClutch}).clutched);
    EXPECT_EQ(mapping.follow({{30, 0, 20}, kClutch}).hip_mm, glm::dvec3(10, 0, 20));
    EXPECT_EQ(mapping.follow({{30, 5, 20}, 0}).hip_mm, glm::dvec3(10, 5, 20));
  }
}

TEST(WorkspaceMapping, OtherButtonsAreNoClutch) {
  WorkspaceMapping mapping(workspace({-100, -80, -40}, {100, 80, 80}), kVolume);
  EXPECT_FALSE(mapping.follow({{0, 0, 0}, 1U | 4U | 8U}).clutched);
}

TEST(WorkspaceMapping, TheEdgesPushBackSoftlyAndNeverMoreThanAtTheEnd) {
  WorkspaceMapping mapping(workspace({-100, -80, -40}, {100, 80, 80}), kVolume);
  EXPECT_EQ(mapping.follow({{95.9, 0, 0}, 0}).edge_force_n, glm::dvec3(0));
  EXPECT_NEAR(mapping.follow({{98, 0, 0}, 0}).edge_force_n.x, -0.4, 1e-12);
  EXPECT_NEAR(mapping.follow({{-99, 0, 0}, 0}).edge_force_n.x, 0.6, 1e-12);
  EXPECT_NEAR(mapping.follow({{0, 0, 300}, 0}).edge_force_n.z, -0.8, 1e-12);
  EXPECT_NEAR(mapping.follow({{0, -300, 0}, 0}).edge_force_n.y, 0.8, 1e-12);
}

}  // namespace
}  // namespace relievo
