// SPDX-License-Identifier: Apache-2.0
// The haptic task with a method that pushes everywhere: a device that returns, another film.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/unit/haptics/haptic_task_stage.h"

namespace relievo::test {
namespace {

// Pushes with 1 N, wherever the finger is.
class Pusher final : public TouchMethod {
 public:
  Touch update(const glm::dvec3& hip_mm, const SurfaceWindow&, MediaTime) RELIEVO_RT override {
    return {.proxy_mm = hip_mm + glm::dvec3(0, 0, 1 / kStiffness), .force_n = {0, 0, 1}, .contact = true};
  }
  void reset() RELIEVO_RT override { ++resets; }
  int resets = 0;
};

class PushedTaskTest : public HapticTaskTest {
 protected:
  void SetUp() override {
    HapticTaskTest::SetUp();
    task_ = std::make_unique<HapticTask>(device_, pusher_, clock_, kVolume, kLimits, kStiffness);
  }
  // While no tick runs, as the player does: two seconds.
  void plugInAgain() {
    device_.close();
    ASSERT_TRUE(device_.open() && device_.home() && device_.start());
    clock_.advance(2s);
  }
  static constexpr SafetyLimits kLimits{.limit_energy = false};
  Pusher pusher_;
};

TEST_F(PushedTaskTest, ADeviceThatIsBackIsPushedFromZeroOnAtTheScenesRate) {
  tick(50);
  ASSERT_NEAR(device_.force.z, 1, 1e-9);
  device_.next_error = ErrorCode::Lost;
  tick();
  EXPECT_EQ(pusher_.resets, 1) << "what the method remembers is not so any more";
  plugInAgain();
  task_->deviceIsBack();
  for (int i = 0; i <= 20; ++i) {
    tick();
    ASSERT_NEAR(device_.force.z, 0.05 * i, 1e-9) << i << ": 50 N/s";
  }
}

TEST_F(PushedTaskTest, AnotherFilmIsPushedFromZeroOnAlsoOnADeviceThatWasLost) {
  for (const bool lost : {false, true}) {
    if (lost) device_.next_error = ErrorCode::Lost;
    tick(50);
    plugInAgain();
    Pusher other;
    task_->changeScene(other, kVolume, kLimits, kStiffness);
    for (int i = 0; i <= 20; ++i) {
      tick();
      ASSERT_NEAR(device_.force.z, 0.05 * i, 1e-9) << lost << ' ' << i;
    }
    task_->changeScene(pusher_, kVolume, kLimits, kStiffness);
  }
}

// The spring is loaded with F^2/2K = 1 mJ by each film; 1 N that is held for the 0.1 mm before the finger is where
// nothing was wanted would be an artefact, and is one of the first film alone.
TEST_F(PushedTaskTest, TheEnergyBooksGoOnFromFilmToFilm) {
  tick(50);
  const double first = task_->counters().scene_energy_mj.load();
  EXPECT_NEAR(first, 1, 1e-9);
  task_->changeScene(pusher_, kVolume, kLimits, kStiffness);
  tick(2);
  device_.position.z = 1;  // the force lags: it is 0.05 of the 1 N
  tick();
  const double artefact = task_->counters().artefact_energy_mj.load();
  EXPECT_NEAR(artefact, 0.05 - 1, 0.03);
  tick(50);
  const double second = task_->counters().scene_energy_mj.load();
  EXPECT_GT(second, first + 0.5);
  task_->changeScene(pusher_, kVolume, kLimits, kStiffness);
  tick(50);
  EXPECT_NEAR(task_->counters().scene_energy_mj.load(), second + 1, 1e-9);
  EXPECT_NEAR(task_->counters().artefact_energy_mj.load(), artefact, 1e-9);
}

TEST_F(PushedTaskTest, AnotherFilmHasABoxOfItsOwnAndAHandThatIsToldByIt) {
  // 192 mm of the device are free: a picture of 384 is reached at two scene millimetres for one.
  task_->changeScene(pusher_, {.width_mm = 384, .height_mm = 108, .depth_mm = 40}, kLimits, kStiffness);
  device_.position = {10, 0, 0};
  tick();
  ASSERT_TRUE(task_->refreshFinger());
  EXPECT_NEAR(task_->finger().hip_mm.x, 20, 1e-9);
  // A wall of K is felt as one of 2 K: the hand's 0.5 mm may change the force by 0.5 N, the scene by 0.05 more.
  device_.position = {10.5, 0, 0};
  tick();
  EXPECT_NEAR(device_.force.z, 0.55, 1e-9);
}

TEST_F(PushedTaskTest, WhatWasLateOfOneFilmIsNotToldOfTheNext) {
  publishPlane(20);
  tick(200);
  ASSERT_EQ(faults(), std::vector{HapticFault::Kind::FeedStale});
  task_->changeScene(pusher_, kVolume, kLimits, kStiffness);
  publishPlane(20);
  tick();
  EXPECT_TRUE(faults().empty());
}

}  // namespace
}  // namespace relievo::test
