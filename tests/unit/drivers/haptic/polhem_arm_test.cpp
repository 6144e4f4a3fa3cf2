// SPDX-License-Identifier: Apache-2.0
// The arm's kinematics compared with separately rotated bodies and with virtual work, for every published device, over
// its whole workspace.
#include "drivers/polhem/arm.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <random>

#include "drivers/polhem/report.h"
#include "tests/support/device/polhem_model.h"

namespace relievo::polhem {
namespace {

using test::PolhemModel;

constexpr const char* kPublic[] = {"woodenhaptics-2019", "woodenhaptics-2015", "polhem-1", "aluhaptics-2", "vintage"};

Description publicDevice(const std::string& name) {
  return loadDescription(RELIEVO_SOURCE_DIR "/drivers/polhem/" + name + ".json").value();
}

// Random positions in the spherical workspace that the arm reaches without being straight.
class Places {
 public:
  explicit Places(const Description& arm) : arm_(arm), radius_mm_(1e3 * arm.workspace_radius) {}
  glm::dvec3 next() {
    for (;;) {
      const glm::dvec3 place = radius_mm_ * std::cbrt(unit_(random_)) * direction();
      const glm::dvec3 angles = PolhemModel::anglesAt(place, arm_);
      const double bend = angles.y + angles.z;  // pi: straight; NaN: unreachable
      if (std::sin(bend) > 0.2) return place;
    }
  }
  glm::dvec3 direction() {
    const glm::dvec3 d(normal_(random_), normal_(random_), normal_(random_));
    return glm::normalize(d);
  }
  double unit() { return unit_(random_); }

 private:
  Description arm_;
  double radius_mm_;
  std::mt19937_64 random_{1906};
  std::uniform_real_distribution<double> unit_{0, 1};
  std::normal_distribution<double> normal_;
};

class PolhemArm : public testing::TestWithParam<const char*> {
 protected:
  Description device_ = publicDevice(GetParam());
  Arm arm_{device_};
  Places places_{device_};
};
INSTANTIATE_TEST_SUITE_P(Devices, PolhemArm, testing::ValuesIn(kPublic), [](const auto& test) {
  std::string name = test.param;
  std::erase(name, '-');
  return name;
});

TEST_P(PolhemArm, IsWhereTheModelsBodiesPutIt) {
  double worst_mm = 0;
  for (int i = 0; i < 200'000; ++i) {  // a million over the five devices
    const glm::dvec3 place = places_.next();
    worst_mm = std::max(worst_mm, glm::distance(arm_.positionOf(PolhemModel::anglesAt(place, device_)), place));
  }
  EXPECT_LT(worst_mm, 1e-3);
  RecordProperty("worst_nm", std::to_string(worst_mm * 1e6));
}

TEST_P(PolhemArm, AnyAnglesPutItWhereTheModelsAre) {
  for (int i = 0; i < 20'000; ++i) {
    const glm::dvec3 theta = 3.0 * places_.direction();
    ASSERT_LT(glm::distance(arm_.positionOf(theta), PolhemModel::placeOf(theta, device_)), 1e-9);
  }
}

TEST_P(PolhemArm, CountsAreAnglesWithinHalfACount) {
  for (int i = 0; i < 20'000; ++i) {
    const glm::dvec3 place = places_.next();
    const glm::dvec3 theta = arm_.anglesOf(PolhemModel::countsAt(place, device_));
    ASSERT_LT(glm::distance(theta, PolhemModel::anglesAt(place, device_)), 0.5 * std::sqrt(3.0) * 4.1e-4);
    ASSERT_LT(glm::distance(arm_.positionOf(theta), place), 0.08) << "a count is 28 to 86 um";
  }
}

TEST_P(PolhemArm, TheForceOfTheCurrentsIsTheForceThatWasAsked) {
  double worst_angle = 0, worst_magnitude = 0;
  for (int i = 0; i < 20'000; ++i) {
    const glm::dvec3 place = places_.next();
    const glm::dvec3 force = (0.1 + 5 * places_.unit()) * places_.direction();
    const glm::dvec3 currents = arm_.currentsFor(force, PolhemModel::anglesAt(place, device_));
    const glm::dvec3 felt = PolhemModel::forceOf(currents, place, device_);
    worst_magnitude = std::max(worst_magnitude, std::abs(glm::length(felt) / glm::length(force) - 1));
    worst_angle = std::max(worst_angle, glm::degrees(std::asin(glm::length(glm::cross(felt, force)) /
                                                               (glm::length(felt) * glm::length(force)))));
  }
  EXPECT_LT(worst_angle, 0.1);
  EXPECT_LT(worst_magnitude, 0.001);
}

TEST_P(PolhemArm, TheCalibrationPoseIsThatOfItsCounts) {
  const glm::dvec3 theta = arm_.anglesOf(device_.calibrate_enc);
  EXPECT_LT(glm::distance(arm_.positionOf(theta),
                          PolhemModel::placeOf(PolhemModel::anglesOf(device_.calibrate_enc, device_), device_)),
            1e-9);
}

TEST_P(PolhemArm, WhatEveryDirectionAllowsIsWithinTheCurrentsAndNoMoreIs) {
  const double most_n = arm_.forceInEveryDirection(2000);
  const glm::dvec3 theta = PolhemModel::anglesAt({0, 0, 0}, device_);
  double highest = 0;
  for (int i = 0; i < 20'000; ++i) {
    const glm::dvec3 currents = glm::abs(arm_.currentsFor(most_n * places_.direction(), theta));
    highest = std::max({highest, currents.x, currents.y, currents.z});
  }
  EXPECT_LE(highest, 2000.0001);
  EXPECT_GT(highest, 1990);
  RecordProperty("most_n", std::to_string(most_n));
}

TEST(PolhemArmByHand, AWoodenHapticsIsCalibratedWithItsUpperLinkUprightAndItsLowerLinkLevel) {
  const Arm arm(kWoodenHaptics2019);
  const glm::dvec3 theta = arm.anglesOf({0, 0, 6000});  // three turns of 1 : 12 are a quarter
  EXPECT_NEAR(glm::degrees(theta.z), 90, 1e-9);
  // 245 mm out, 80 + 205 mm up, less (220, 80).
  EXPECT_LT(glm::distance(arm.positionOf(theta), {0, 205, 25}), 1e-9);
}

TEST(PolhemArmByHand, ItsAxesPointRightUpAndTowardTheViewer) {
  const Arm arm(kWoodenHaptics2019);
  const glm::dvec3 rest = arm.anglesOf({0, 0, 6000}), place = arm.positionOf(rest);
  EXPECT_GT(arm.positionOf(rest + glm::dvec3(0.1, 0, 0)).x, place.x + 20) << "a turns counter-clockwise from above";
  EXPECT_GT(arm.positionOf(rest + glm::dvec3(0, 0, 0.1)).y, place.y + 20) << "c swings up";
  EXPECT_GT(arm.positionOf(rest + glm::dvec3(0, 0.1, 0)).z, place.z + 20) << "b leans toward the user";
}

TEST(PolhemArmByHand, ANewtonUpTakesTheCurrentOfItsLever) {
  // Lower link level: 1 N x 245 mm on body c, 1 : 12 on the motor, 60.3 mN m/A: 338.6 mA.
  const Arm arm(kWoodenHaptics2019);
  const glm::dvec3 currents = arm.currentsFor({0, 1, 0}, arm.anglesOf({0, 0, 6000}));
  EXPECT_NEAR(currents.z, 338.6, 0.05);
  EXPECT_NEAR(currents.x, 0, 1e-9);
  EXPECT_NEAR(currents.y, 0, 1e-9) << "upright: no lever";
}

TEST(PolhemArmByHand, AMotorThatIsAlignedTurnsBackwards) {
  Description mirrored = kWoodenHaptics2019;
  mirrored.motor_and_body_aligned = {true, true, true};
  const Arm arm(kWoodenHaptics2019), other(mirrored);
  EXPECT_EQ(other.anglesOf({100, 200, -300}), arm.anglesOf({-100, -200, 300}));
  const glm::dvec3 theta(0.1, 0.2, 1.3);
  EXPECT_EQ(other.currentsFor({1, 2, 3}, theta), -arm.currentsFor({1, 2, 3}, theta));
}

TEST(PolhemArmByHand, TheGateLetsThroughWhatAHandCanDoAndNoMore) {
  // The finest count: 205 mm x 2 pi / 2000 / 16 = 0.040 mm; 0.15 mm are 4 counts, plus 2 for rounding.
  EXPECT_EQ(EncoderGate::slackFor(Arm(kWoodenHaptics2019).mmPerCount(), 1000), 6);
}

}  // namespace
}  // namespace relievo::polhem
