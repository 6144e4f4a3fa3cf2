// SPDX-License-Identifier: Apache-2.0
// The laboratory's truth on a step, at rest and in motion.
#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>

#include "tests/unit/lab/oracle_paths.h"

namespace relievo::test {
namespace {

// Places by the step: q mm in front of its wall, at height z, and so far along the wall.
class OnTheStep : public testing::Test {
 protected:
  std::unique_ptr<TrueSurface> surface_ = makeTrueSurface("step");
  StepWall wall_ = wallOf(*surface_, 0);
  Oracle oracle_{*surface_};
  int tick_ = 0;

  [[nodiscard]] glm::dvec3 at(double q, double z, double along = 4) const {
    const glm::dvec2 plan = wall_.normal * (wall_.offset_mm + q) + glm::dvec2(-wall_.normal.y, wall_.normal.x) * along;
    return {plan, z};
  }
  TrueTouch move(double q, double z, double along = 4) { return oracle_.update(at(q, z, along), tick_++ * kTick); }
  void expectProxy(const TrueTouch& touch, double q, double z, double along = 4) const {
    EXPECT_TRUE(touch.contact);
    EXPECT_LT(glm::distance(touch.proxy_mm, at(q, z, along)), 1e-12) << touch.proxy_mm.x << " " << touch.proxy_mm.z;
  }
};

TEST_F(OnTheStep, TopWallAndBottomAreTheirNearestPlaces) {
  move(-6, 30);
  expectProxy(move(-5, 23), -5, 27.5);
  expectProxy(move(-0.25, 10, 9), -0.25, 27.5, 9);  // from the top the wall cannot be reached, however near
  EXPECT_FALSE(move(0.5, 20).contact);
  expectProxy(move(-3, 21), 0, 21);  // in through the wall
  expectProxy(move(-9, 14, 1), 0, 14, 1);
  expectProxy(move(-9, 9, 1), 0, 12.5, 1);  // in the corner
  expectProxy(move(4, 9), 4, 12.5);         // out of it along the bottom
  expectProxy(move(-2, 9), 0, 12.5);
  expectProxy(move(-2, 20), 0, 20);  // up the wall again
  EXPECT_FALSE(move(-2, 27.5).contact);
}

TEST_F(OnTheStep, FloorsAreMetFromFarAbove) {
  move(-6, 39);
  expectProxy(move(-6, 26), -6, 27.5);
  move(3, 39);
  expectProxy(move(3, 12), 3, 12.5);
}

TEST_F(OnTheStep, FallsFromTheTopWhereTheFingerPassesBelowTheBottom) {
  move(-1, 30);
  expectProxy(move(-1, 5), -1, 27.5);
  expectProxy(move(-0.001, 5), -0.001, 27.5);
  expectProxy(move(2, 5), 2, 12.5);
  expectProxy(move(-2, 5), 0, 12.5);
}

TEST_F(OnTheStep, MeetsTheFirstOfWallTopAndBottomOnAFastWay) {
  move(4, 25);
  expectProxy(move(-4, 10), 0, 12.5);  // through the wall at 17.5; 10 is below the corner
  move(4, 34);
  EXPECT_FALSE(move(2, 30).contact);
  expectProxy(move(-4, 15), 0, 15);  // crosses q = 0 at 25
  move(4, 34);
  expectProxy(move(-4, 24), -4, 27.5);  // crosses q = 0 at 29, above the top
  move(2, 20);
  expectProxy(move(-2, 1), 0, 12.5);  // through the bottom at q = 0.42, then into the corner
}

TEST(Oracle, IsPushedByAWallThatSweepsOverTheFinger) {
  const auto s = makeTrueSurface("step-moving", {.speed_mm_per_s = 50});
  const glm::dvec3 hip(-37, 1, 19);
  int contacts = 0;
  for (const auto& [t, at, touch] : follow(*s, [&](double) { return hip; }, 0.3)) {
    const double q = wallOf(*s, t).distance(hip.x, hip.y);
    ASSERT_EQ(touch.contact, q < 0) << t;
    if (!touch.contact) continue;
    ++contacts;
    ASSERT_NEAR(wallOf(*s, t).distance(touch.proxy_mm.x, touch.proxy_mm.y), 0, 1e-12);
    ASSERT_NEAR(touch.proxy_mm.z, 19, 1e-12);
    ASSERT_NEAR(glm::distance(touch.proxy_mm, hip), -q, 1e-12);
  }
  EXPECT_GT(contacts, 200);
}

TEST(Oracle, SeesTheWallMoveWithinATick) {
  const auto s = makeTrueSurface("step-moving", {.speed_mm_per_s = 2000});
  for (const auto& [from_z, to_z, proxy_z] : {std::array{29.0, 25.0, 25.0}, {30.0, 26.0, 27.5}}) {
    Oracle oracle(*s);
    const StepWall wall = wallOf(*s, 0.01);
    const glm::dvec2 plan = wall.normal * (wall.offset_mm + 1);  // the wall goes past it, 1.9 mm in a tick
    EXPECT_FALSE(oracle.update({plan, from_z}, 0.01).contact);
    // It arrives when the finger is a little more than half way down: at 26.9 or at 27.9, the top lying at 27.5.
    EXPECT_EQ(oracle.update({plan, to_z}, 0.011).proxy_mm.z, proxy_z);
  }
}

TEST(Oracle, FollowsAFingerThatTheTopIsPulledAwayFrom) {
  const auto s = makeTrueSurface("step-moving", {.speed_mm_per_s = -50});  // begins at +40 and moves to the left
  // On the top, 3 mm deep, until the edge has passed: then it hangs in free space.
  const Path path = [](double t) { return glm::dvec3(35, 0, t < 0.01 ? 30 : 24.5); };
  bool fell = false;
  for (const auto& [t, hip, touch] : follow(*s, path, 0.3)) {
    const double q = wallOf(*s, t).distance(hip.x, hip.y);
    ASSERT_EQ(touch.contact, t > 0.0095 && q < 0) << t;
    if (touch.contact) {
      ASSERT_NEAR(touch.proxy_mm.z, 27.5, 1e-12);
    }
    fell = fell || q > 0;
  }
  EXPECT_TRUE(fell);
}

}  // namespace
}  // namespace relievo::test
