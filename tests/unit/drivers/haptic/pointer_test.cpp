// SPDX-License-Identifier: Apache-2.0
// The mouse as a haptic device: pointing, pressing, buttons, lost events and a lost mouse, in simulated time.
#include "drivers/pointer/pointer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "app/haptics/task/workspace_mapping.h"
#include "tests/support/device/fake_mouse.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
constexpr glm::dvec3 kStart(0, 0, 46);

class PointerTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(device_->open() && device_->home() && device_->start()); }

  // The sample after that many ticks, on which a surface of 0.5 N/mm at that height pushed back.
  HapticSample after(int ticks, double surface_mm = -1000) {
    HapticSample sample;
    for (int i = 0; i < ticks; ++i) {
      clock_.advance(1ms);
      const auto read = device_->read();
      EXPECT_TRUE(read);
      if (!read) return sample;
      fastest_ = std::max(fastest_, glm::distance(read->position_mm, sample_.position_mm));
      sample_ = sample = *read;
      force_n_ = 0.5 * std::max(0.0, surface_mm - sample.position_mm.z);
      EXPECT_TRUE(device_->write({0, 0, std::min(force_n_, 8.0)}));
    }
    return sample;
  }

  ManualClock clock_{MonotonicTime(1h)};
  std::shared_ptr<test::FakeMouse> mouse_ = std::make_shared<test::FakeMouse>();
  std::unique_ptr<HapticDevice> device_ = makePointer(std::make_unique<test::FakeMousePort>(mouse_), clock_);
  HapticSample sample_{.position_mm = kStart};
  double fastest_ = 0;  // mm a tick
  double force_n_ = 0;
};

TEST_F(PointerTest, MovesATenthOfAMillimetreACountAndTwoANotch) {
  EXPECT_EQ(after(1).position_mm, kStart);
  mouse_->move(200, 0);
  mouse_->move(0, -300);  // away from the user: up
  mouse_->move(0, 0, 3);  // forward: away from the viewer
  EXPECT_LT(glm::distance(after(200).position_mm, glm::dvec3(20, 30, 40)), 1e-6);
  mouse_->move(-50, 100, -1);
  EXPECT_LT(glm::distance(after(200).position_mm, glm::dvec3(15, 20, 42)), 1e-6);
}

// After one time constant, 10 ms, 1/e of the distance remains.
TEST_F(PointerTest, GoesThereSmoothly) {
  mouse_->move(100, 0);
  EXPECT_NEAR(after(10).position_mm.x, 10 * (1 - std::exp(-1.0)), 1e-9);
  EXPECT_LT(fastest_, 1.0);
}

TEST_F(PointerTest, StaysWithinItsWorkspace) {
  mouse_->move(100'000, -100'000, 1000);
  EXPECT_LT(glm::distance(after(300).position_mm, glm::dvec3(100, 75, -20)), 1e-6);
  mouse_->move(-1, 1, -1);
  EXPECT_LT(glm::distance(after(300).position_mm, glm::dvec3(99.9, 74.9, -18)), 1e-6) << "it turns back at once";
}

TEST_F(PointerTest, PressesAtEightyMillimetresASecondAndComesBack) {
  mouse_->turn(BTN_LEFT, true);
  EXPECT_NEAR(after(400).position_mm.z, 46 - 0.08 * 400 + 0.08 * 10, 0.05) << "behind by the time constant";
  EXPECT_LE(fastest_, 0.08 + 1e-9);
  mouse_->turn(BTN_LEFT, false);
  const double turned = after(60).position_mm.z;
  EXPECT_NEAR(after(100).position_mm.z, turned + 0.08 * 100, 0.01);
  EXPECT_LT(glm::distance(after(500).position_mm, kStart), 1e-6);
  EXPECT_LE(fastest_, 0.08 + 1e-9);
}

TEST_F(PointerTest, RestsOnTheSurfaceWithTwoNewtonsWhereverItIs) {
  mouse_->turn(BTN_LEFT, true);
  for (const double surface : {35.0, 10.0, 30.0, 20.0}) {
    after(1500, surface);
    EXPECT_NEAR(force_n_, 2.0, 0.01) << surface;
  }
}

TEST_F(PointerTest, AForceThatIsNotRenewedIsForgotten) {
  mouse_->turn(BTN_LEFT, true);
  after(1500, 30);
  const double held = sample_.position_mm.z;
  for (int i = 0; i < 200; ++i) {  // reads only
    clock_.advance(1ms);
    ASSERT_TRUE(device_->read());
  }
  EXPECT_LT(device_->read()->position_mm.z, held - 10);
}

TEST_F(PointerTest, TheMiddleButtonIsTheMainOneAndTheRightOneTheClutch) {
  mouse_->turn(BTN_LEFT, true);
  EXPECT_EQ(after(1).buttons, 0u) << "it presses";
  mouse_->turn(BTN_MIDDLE, true);
  EXPECT_EQ(after(1).buttons, 1u);
  mouse_->turn(BTN_RIGHT, true);
  EXPECT_EQ(after(1).buttons, 3u);
  mouse_->turn(BTN_MIDDLE, false);
  EXPECT_EQ(after(1).buttons, 2u);
  mouse_->turn(BTN_SIDE, true);
  mouse_->turn(BTN_RIGHT, false);
  EXPECT_EQ(after(1).buttons, 0u);
}

// The kernel's buffer overflowed: the rest of that report is invalid, and a release may have been lost.
TEST_F(PointerTest, AfterDroppedEventsTheButtonsAreAskedForAnew) {
  mouse_->turn(BTN_MIDDLE, true);
  EXPECT_EQ(after(1).buttons, 1u);
  mouse_->say(EV_SYN, SYN_DROPPED, 0);
  mouse_->say(EV_REL, REL_X, 500);
  mouse_->down = kRightButton;
  mouse_->report();
  mouse_->move(10, 0);
  EXPECT_EQ(after(200).buttons, 2u);
  EXPECT_NEAR(sample_.position_mm.x, 1.0, 1e-6);
}

TEST_F(PointerTest, WhatTheMouseDidBeforeTheStartIsNotMeantForTheFinger) {
  device_->stop();
  mouse_->move(100, 100);
  mouse_->turn(BTN_MIDDLE, true);
  mouse_->turn(BTN_MIDDLE, false);
  mouse_->down = kRightButton;
  ASSERT_TRUE(device_->start());
  EXPECT_EQ(after(200).buttons, 2u);
  EXPECT_EQ(sample_.position_mm, kStart);
}

TEST_F(PointerTest, MoreEventsThanATickReadsComeWithTheNext) {
  for (int i = 0; i < 1000; ++i) mouse_->move(1, 0);
  EXPECT_NEAR(after(300).position_mm.x, 100, 1e-6);
  EXPECT_TRUE(mouse_->events.empty());
}

TEST_F(PointerTest, AnUnpluggedMouseIsLost) {
  mouse_->plugged = false;
  EXPECT_EQ(device_->read().error().code, ErrorCode::Lost);
  EXPECT_EQ(device_->state(), HapticDevice::State::Lost);
  device_->close();
  EXPECT_FALSE(mouse_->open);
  EXPECT_EQ(device_->open().error().code, ErrorCode::NotFound);
}

TEST_F(PointerTest, AMouseThatGoesBeforeTheStartIsLost) {
  device_->stop();
  mouse_->plugged = false;
  EXPECT_EQ(device_->start().error().code, ErrorCode::Lost);
}

// ---- over a window ----

class WindowPointerTest : public testing::Test {
 protected:
  void point(const SceneRay& ray) {
    mouse_.ray = ray;
    publish();
  }
  void publish() {
    window_->mouse.back() = mouse_;
    window_->mouse.publish();
  }
  void start() {
    publish();
    window_->open = true;
    ASSERT_TRUE(device_->open() && device_->home() && device_->start());
  }
  HapticSample after(int ticks) {
    HapticSample sample;
    for (int i = 0; i < ticks; ++i) {
      clock_.advance(1ms);
      const auto read = device_->read();
      EXPECT_TRUE(read);
      if (read) sample = *read;
    }
    return sample;
  }

  ManualClock clock_{MonotonicTime(1h)};
  WindowMouse mouse_;
  std::shared_ptr<WindowInput> window_ = std::make_shared<WindowInput>();
  std::unique_ptr<HapticDevice> device_ = makePointer(window_, clock_);
};

// An eye 600 mm before the screen plane, which is at 20 mm: at 46 mm the line has come 26/600 of its way to the eye.
TEST_F(WindowPointerTest, TheFingerIsOnTheLineOfSightThroughTheMouse) {
  point({.screen_mm = {60, -30}, .screen_z_mm = 20, .viewing_distance_mm = 600, .depth_mm = 40});
  start();
  const double share = 1 - 26.0 / 600;
  EXPECT_LT(glm::distance(after(300).position_mm, glm::dvec3(60 * share, -30 * share, 46)), 1e-6);
  point({.screen_mm = {60, -30}, .eye_x_mm = -31.5, .screen_z_mm = 20, .viewing_distance_mm = 600, .depth_mm = 40});
  EXPECT_LT(glm::distance(after(300).position_mm, glm::dvec3(-31.5 + 91.5 * share, -30 * share, 46)), 1e-6);
}

TEST_F(WindowPointerTest, ThePressedFingerStaysOnTheLine) {
  point({.screen_mm = {60, -30}, .screen_z_mm = 20, .viewing_distance_mm = 600, .depth_mm = 40});
  start();
  mouse_.left = true;
  publish();
  after(500);
  const glm::dvec3 place = after(1).position_mm;
  EXPECT_LT(place.z, 15);
  EXPECT_NEAR(place.x, 60 * (1 - (place.z - 20) / 600), 0.1);
}

TEST_F(WindowPointerTest, TheFingerIsAboveADeeperVolumeAsWell) {
  start();
  point({.screen_mm = {0, 0}, .screen_z_mm = 20, .viewing_distance_mm = 600, .depth_mm = 100});
  EXPECT_NEAR(after(300).position_mm.z, 106, 1e-6);
  point({.screen_mm = {0, 0}, .screen_z_mm = 20, .viewing_distance_mm = 600, .depth_mm = 40});
  EXPECT_NEAR(after(300).position_mm.z, 46, 1e-6);
}

TEST_F(WindowPointerTest, ItsPlaceIsTheScenesWhateverTheVolume) {
  point({.screen_mm = {60, -30}, .screen_z_mm = 20, .viewing_distance_mm = 600, .depth_mm = 40});
  start();
  const HapticSample sample = after(300);
  for (const DisplayVolume& volume : {DisplayVolume{160, 90, 40}, DisplayVolume{4000, 90, 100}}) {
    WorkspaceMapping mapping(device_->capabilities(), volume);
    EXPECT_EQ(mapping.scale(), 1);
    EXPECT_EQ(mapping.follow(sample).hip_mm, sample.position_mm);
    EXPECT_EQ(mapping.follow(sample).edge_force_n, glm::dvec3(0));
  }
}

TEST_F(WindowPointerTest, WheelAndButtonsAreThoseOfAMouse) {
  mouse_.notches = 7;  // turned before
  start();
  mouse_.notches = 10;
  mouse_.right = true;
  publish();
  const HapticSample sample = after(300);
  EXPECT_NEAR(sample.position_mm.z, 40, 1e-6);
  EXPECT_EQ(sample.buttons, 2u);
  mouse_.right = false;
  mouse_.middle = true;
  publish();
  EXPECT_EQ(after(1).buttons, 1u);
  mouse_.middle = false;
  mouse_.left = true;
  publish();
  EXPECT_LT(after(300).position_mm.z, 20) << "it presses";
  EXPECT_EQ(after(1).buttons, 0u);
}

TEST_F(WindowPointerTest, AButtonHeldWhenItBeginsIsDown) {
  mouse_.right = true;
  start();
  EXPECT_EQ(after(1).buttons, 2u);
}

TEST_F(WindowPointerTest, WithoutAWindowThereIsNothingToPointIn) {
  EXPECT_EQ(device_->open().error().code, ErrorCode::NotFound);
  start();
  window_->open = false;
  EXPECT_EQ(device_->read().error().code, ErrorCode::Lost);
}

}  // namespace
}  // namespace relievo
