// SPDX-License-Identifier: Apache-2.0
// The words for simulated devices and hands, and the hands' built-in motions.
#include "drivers/sim/profiles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>

namespace relievo {
namespace {

using testing::HasSubstr;

std::string scriptFile(const char* name) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path) << "t_s,x_mm,y_mm,z_mm\n0,30,-12,6\n";
  return path;
}

TEST(SimWords, NothingIsThePhantomInAStrokingHand) {
  const SimSetup setup = parseSim("").value();
  EXPECT_STREQ(setup.profile.name, "sim");
  EXPECT_EQ(setup.profile.moving_mass_kg, 0.075);
  EXPECT_EQ(setup.path.at(7.7).position_mm, HandPath().at(7.7).position_mm);
}

TEST(SimWords, ADeviceAHandAndAScriptMayComeInAnyOrder) {
  const std::string script = scriptFile("sim_words.csv");
  EXPECT_STREQ(parseSim("falcon")->profile.name, "sim falcon");
  EXPECT_STREQ(parseSim("polhem,tense")->profile.name, "sim polhem");
  EXPECT_EQ(parseSim("tense,polhem")->profile.hand.stiffness_n_per_mm, 1.5);
  EXPECT_EQ(parseSim("tapping")->path.at(0.9).position_mm, HandPath(HandMotion::Tapping).at(0.9).position_mm);
  for (const std::string& words : {script, "falcon," + script, script + ",tense,phantom"}) {
    const auto setup = parseSim(words);
    ASSERT_TRUE(setup) << words;
    EXPECT_EQ(setup->path.at(3).position_mm, glm::dvec3(30, -12, 6)) << words;
  }
  EXPECT_EQ(parseSim(script + ",tense")->profile.hand.stiffness_n_per_mm, 1.5);
}

TEST(SimWords, AScriptsNameMayHaveAComma) {
  EXPECT_EQ(parseSim(scriptFile("sim,words.csv"))->path.at(3).position_mm, glm::dvec3(30, -12, 6));
}

TEST(SimWords, EachKnownWordIsListed) {
  std::string all;
  for (const auto& device : simDevices()) all += std::string(all.empty() ? "" : " ") + device.word;
  all += ",";
  for (const auto& hand : simHands()) all += std::string(" ") + hand.word;
  EXPECT_EQ(kSimWords, all);
}

TEST(SimWords, AnUnknownWordIsRefusedWithTheKnownOnes) {
  for (const char* words : {"flacon", "falcon,tens", "falcon,", ",", "FALCON"}) {
    const auto setup = parseSim(words);
    ASSERT_FALSE(setup) << words;
    EXPECT_EQ(setup.error().error.code, ErrorCode::InvalidArgument);
    EXPECT_THAT(setup.error().error.message, HasSubstr(kSimWords));
  }
  EXPECT_EQ(parseSim("falcon,tens").error().thing, "--haptic sim, \"tens\"");
}

TEST(SimWords, TwoOfAKindAreRefused) {
  const std::string script = scriptFile("sim_words.csv");
  for (const std::string& words : {std::string("falcon,polhem"), std::string("tense,shaking"), script + "," + script}) {
    const auto setup = parseSim(words);
    ASSERT_FALSE(setup) << words;
    EXPECT_THAT(setup.error().error.message, HasSubstr("second"));
  }
}

TEST(SimWords, APathThatIsNotThereIsNotFound) {
  const auto setup = parseSim("falcon,/nonexistent/hand.csv");
  ASSERT_FALSE(setup);
  EXPECT_EQ(setup.error().error.code, ErrorCode::NotFound);
  EXPECT_EQ(setup.error().thing, "/nonexistent/hand.csv");
}

TEST(SimDevices, MoveAboutTheMiddleOfTheDefaultVolume) {
  for (const auto& device : simDevices()) {
    EXPECT_EQ(0.5 * (device.profile.workspace_min_mm + device.profile.workspace_max_mm), glm::dvec3(0, 0, 20))
        << device.word;
  }
}

// Half a second above every surface, then the hand's motion: down below every surface, never out at the sides.
TEST(SimHands, BeginAtRestInFrontAndStayWithinTheWorkspace) {
  for (const auto& device : simDevices()) {
    for (const auto& hand : simHands()) {
      SCOPED_TRACE(std::string(device.word) + ", " + hand.word);
      const SimSetup setup = parseSim(std::string(device.word) + "," + hand.word).value();
      double lowest = 1e9, fastest = 0;
      for (int ms = 0; ms < 30'000; ++ms) {
        const glm::dvec3 at = setup.path.at(0.001 * ms).position_mm;
        ASSERT_TRUE(ms >= 500 || at.z > 40);
        lowest = std::min(lowest, at.z);
        fastest = std::max(fastest, 1e3 * glm::distance(at, setup.path.at(0.001 * (ms + 1)).position_mm));
        for (int axis = 0; axis < 2; ++axis) {
          ASSERT_GT(at[axis], setup.profile.workspace_min_mm[axis] + 5);
          ASSERT_LT(at[axis], setup.profile.workspace_max_mm[axis] - 5);
        }
        ASSERT_LE(at.z, setup.profile.workspace_max_mm.z - 5);
      }
      EXPECT_LT(lowest, 0);
      EXPECT_LT(fastest, 310);
    }
  }
}

TEST(SimHands, ShakeNineTimesASecond) {
  const HandPath path(HandMotion::Shaking);
  int rises = 0;
  for (int ms = 3'000; ms < 5'000; ++ms) {
    rises += path.at(0.001 * ms).position_mm.x < 0 && path.at(0.001 * (ms + 1)).position_mm.x >= 0 ? 1 : 0;
  }
  EXPECT_EQ(rises, 18);
}

}  // namespace
}  // namespace relievo
