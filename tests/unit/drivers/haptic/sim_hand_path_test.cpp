// SPDX-License-Identifier: Apache-2.0
// The paths of the simulated hand: built-in ones, and a script's.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>

#include "drivers/sim/hand_path.h"
#include "drivers/sim/sim.h"

namespace relievo {
namespace {

constexpr const char* kScript =
    "t_s,x_mm,y_mm,z_mm\n"
    "1.0,0,0,60\n"
    "2.0,10,-20,40\r\n"
    "4.0,10,-20,0\n";

TEST(SimHandPath, GoesStraightFromRowToRowAndHoldsItsEnds) {
  const auto path = HandPath::parse(kScript, "script");
  ASSERT_TRUE(path);
  EXPECT_EQ(path->at(0.0).position_mm, glm::dvec3(0, 0, 60));
  EXPECT_EQ(path->at(1.0).position_mm, glm::dvec3(0, 0, 60));
  EXPECT_EQ(path->at(1.5).position_mm, glm::dvec3(5, -10, 50));
  EXPECT_EQ(path->at(2.0).position_mm, glm::dvec3(10, -20, 40));
  EXPECT_EQ(path->at(3.0).position_mm, glm::dvec3(10, -20, 20));
  EXPECT_EQ(path->at(4.0).position_mm, glm::dvec3(10, -20, 0));
  EXPECT_EQ(path->at(1e6).position_mm, glm::dvec3(10, -20, 0));
  EXPECT_TRUE(std::isinf(path->at(1.5).force_limit_n)) << "a script pulls as hard as it must";
}

class SimHandPathWrong : public testing::TestWithParam<const char*> {};
TEST_P(SimHandPathWrong, IsRefused) {
  const auto path = HandPath::parse(GetParam(), "script");
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().error.code, ErrorCode::InvalidArgument);
}
INSTANTIATE_TEST_SUITE_P(Scripts, SimHandPathWrong,
                         testing::Values("",                                            // nothing
                                         "0,0,0,0\n",                                   // no header
                                         "t_s,x_mm,y_mm,z_mm\n",                        // no row
                                         "t_s,x_mm,y_mm,z_mm\n0,1,2\n",                 // three numbers
                                         "t_s,x_mm,y_mm,z_mm\n0,1,2,3,4\n",             // five
                                         "t_s,x_mm,y_mm,z_mm\n0,1,2,nan\n",             // not finite
                                         "t_s,x_mm,y_mm,z_mm\n0,1,2,3x\n",              // not a number
                                         "t_s,x_mm,y_mm,z_mm\n0,1,2,3\n0,1,2,3\n",      // no time goes by
                                         "t_s,x_mm,y_mm,z_mm\n0,1,2,3\n\n1,1,2,3\n"));  // an empty line

TEST(SimHandPath, NamesTheWrongLine) {
  const auto path = HandPath::parse("t_s,x_mm,y_mm,z_mm\n0,1,2,3\n1,oops\n", "hand.csv");
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().thing, "hand.csv:3");
}

TEST(SimHandPath, AMissingFileIsNotFound) {
  const auto path = HandPath::load("/nonexistent/hand.csv");
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().error.code, ErrorCode::NotFound);
}

TEST(SimHandPath, ItsOwnPathRestsInFrontThenComesDownAboutTheMiddleAndLeavesIt) {
  const HandPath path;
  for (const double t : {0.0, 0.25, 0.5}) EXPECT_EQ(path.at(t).position_mm, glm::dvec3(0, 0, 48)) << t;
  const auto aside = [&](double t) { return std::hypot(path.at(t).position_mm.x, path.at(t).position_mm.y); };
  EXPECT_LT(aside(1.3), 15.0) << "20 mm, half way down";
  EXPECT_LT(path.at(1.7).position_mm.z, 0.0);
  EXPECT_GT(aside(2.2), 45.0) << "whatever hole there is in the middle, it is soon beside it";
}

// The finger must leave the solid regularly, since a finger that fell into it is not held before it is out again.
TEST(SimHandPath, ItsOwnPathComesOutEveryFourSeconds) {
  const HandPath path;
  for (int round = 1; round < 30; ++round) {
    EXPECT_GT(path.at(0.5 + 4.0 * round).position_mm.z, 40.0) << "above the nearest surface, round " << round;
    EXPECT_LT(path.at(2.5 + 4.0 * round).position_mm.z, 0.0) << "below the farthest, round " << round;
  }
}

TEST(SimHandPath, ItsOwnPathIsSlowUnbrokenAndInReach) {
  const HandPath path;
  HandPoint before = path.at(0);
  for (int i = 1; i < 120'000; ++i) {
    const HandPoint now = path.at(i * 1e-3);
    ASSERT_LT(glm::distance(now.position_mm, before.position_mm), 0.1) << "100 mm/s at " << i << " ms";
    ASSERT_LT(std::abs(now.position_mm.x), 60) << i;
    ASSERT_LT(std::abs(now.position_mm.y), 40) << i;
    ASSERT_GE(now.position_mm.z, -12.0 - 1e-9) << i;
    ASSERT_GE(now.force_limit_n, 1.0 - 1e-9) << i;
    ASSERT_LE(now.force_limit_n, 2.0 + 1e-9) << i;
    before = now;
  }
}

// What was simulated of the time between start and first tick would make that tick the longest.
TEST(SimHandPath, BeginsWithTheFirstReading) {
  ManualClock clock;
  DeviceProfile profile;
  profile.encoder_step_mm = 0;
  const auto device = makeSimHaptic(profile, HandPath({{0.0, {0, 0, 20}}, {0.1, {0, 0, 40}}}), clock);
  ASSERT_TRUE(device->open() && device->home() && device->start());
  clock.advance(std::chrono::milliseconds(20));
  EXPECT_EQ(device->read()->position_mm, glm::dvec3(0, 0, 20));
  clock.advance(std::chrono::milliseconds(1));
  EXPECT_GT(device->read()->position_mm.z, 20);
}

}  // namespace
}  // namespace relievo
