// SPDX-License-Identifier: Apache-2.0
// Gamepads, joysticks and wheels as haptic devices: who moves the finger, what is played, when it falls silent; in
// simulated time.
#include "drivers/gamepad/gamepad.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "app/haptics/method/relievo_method.h"
#include "app/haptics/task/haptic_task.h"
#include "drivers/gamepad/pad_controls.h"
#include "tests/support/device/fake_pad.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
constexpr glm::dvec3 kStart(0, 0, 55);

class GamepadTest : public testing::Test {
 protected:
  void run(const PadFacts& facts) {
    pad_->facts = facts;
    ASSERT_TRUE(device_->open() && device_->home());
    const auto started = device_->start();
    ASSERT_TRUE(started) << started.error().message;
  }
  // The sample after that many ticks, on a surface of 0.5 N/mm at that height.
  HapticSample after(int ticks, double surface_mm = -1000) {
    HapticSample sample;
    for (int i = 0; i < ticks; ++i) {
      clock_.advance(1ms);
      const auto read = device_->read();
      EXPECT_TRUE(read);
      if (!read) return sample;
      sample = *read;
      force_n_ = {0, 0, std::min(0.5 * std::max(0.0, surface_mm - sample.position_mm.z), 4.0)};
      EXPECT_TRUE(device_->write(force_n_));
    }
    return sample;
  }
  void push(const glm::dvec3& force_n, int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      clock_.advance(1ms);
      ASSERT_TRUE(device_->read());
      ASSERT_TRUE(device_->write(force_n));
    }
  }

  ManualClock clock_{MonotonicTime(1h)};
  std::shared_ptr<test::FakePad> pad_ = std::make_shared<test::FakePad>();
  std::unique_ptr<HapticDevice> device_ =
      makeGamepad(std::make_unique<test::FakePadPort>(pad_), clock_, {.effect_thread = false});
  glm::dvec3 force_n_{0};
};

TEST_F(GamepadTest, APadsStickMovesTheFingerAtAHundredMillimetresASecond) {
  run(test::xboxPad());
  EXPECT_EQ(after(1).position_mm, kStart);
  pad_->turn(ABS_X, 32767);
  EXPECT_NEAR(after(500).position_mm.x, 50, 0.5);
  pad_->turn(ABS_X, 2000);  // let go: a worn stick rests off its middle
  const double rests = after(1).position_mm.x;
  EXPECT_EQ(after(500).position_mm.x, rests) << "the finger stays where it is";
  pad_->turn(ABS_Y, -32768);  // pushed forward: up
  EXPECT_NEAR(after(400).position_mm.y, 40, 0.5);
  EXPECT_EQ(after(2000).position_mm.y, 70) << "inside the workspace, whose ends would push back";
}

// At half of the way beyond the dead zone, (0.56 - 0.12)/0.88, the speed is a quarter.
TEST_F(GamepadTest, HalfWayTheStickIsFourTimesFiner) {
  run(test::xboxPad());
  pad_->turn(ABS_X, static_cast<int>(0.56 * 32768));
  EXPECT_NEAR(after(1000).position_mm.x, 25, 0.3);
}

TEST_F(GamepadTest, AWallThatOnlyRumblesStopsTheFingerAtTwoNewtons) {
  run(test::xboxPad());
  pad_->turn(ABS_X, 32767);
  double wall_n = 0, x_mm = 0;
  for (int i = 0; i < 3000; ++i) {
    clock_.advance(1ms);
    x_mm = device_->read()->position_mm.x;
    wall_n = 0.5 * std::max(0.0, x_mm - 20);
    ASSERT_TRUE(device_->write({-std::min(wall_n, 4.0), 0, 0}));
  }
  EXPECT_NEAR(wall_n, 2, 0.05);
  EXPECT_LT(x_mm, 24.1);
}

// The depth goal is 70 mm x pull below the start, and each millimetre that is missing presses with 0.1 N.
TEST_F(GamepadTest, ATriggerPressesAsDeepAsItIsPulled) {
  run(test::xboxPad());
  pad_->turn(ABS_RZ, 51);  // a fifth
  EXPECT_NEAR(after(1000).position_mm.z, 55 - 14, 0.01);
  pad_->turn(ABS_RZ, 255);
  const double z_mm = after(2000, 20).position_mm.z;
  EXPECT_NEAR(0.1 * (z_mm + 15), 0.5 * (20 - z_mm), 1e-3) << "trigger and surface hold each other";
  EXPECT_NEAR(force_n_.z, 2.917, 0.01);
  pad_->turn(ABS_RZ, 0);
  EXPECT_NEAR(after(1000, 20).position_mm.z, 55, 0.01);
  pad_->turn(ABS_Z, 255);
  EXPECT_NEAR(after(2000, 20).position_mm.z, z_mm, 1e-3) << "the other trigger as well";
}

TEST_F(GamepadTest, TheFingerIsNeverFasterThanAHand) {
  run(test::xboxPad());
  pad_->turn(ABS_RZ, 255);
  double last = 55;
  for (int i = 0; i < 1000; ++i) {
    const double z = after(1, i < 500 ? -1000 : 40).position_mm.z;
    EXPECT_LE(std::abs(z - last), 0.2 + 1e-9);
    last = z;
  }
}

TEST_F(GamepadTest, AJoystickIsWhereItsStickIs) {
  run(test::joystick());
  pad_->turn(ABS_X, 1023);
  EXPECT_NEAR(after(200).position_mm.x, 95, 1e-3);
  pad_->turn(ABS_X, 256);
  pad_->turn(ABS_Y, 0);
  EXPECT_LT(glm::distance(after(200).position_mm, glm::dvec3(95 * (256 / 511.5 - 1), 70, 55)), 1e-3);
  pad_->turn(ABS_RZ, 255);
  EXPECT_NEAR(after(200).position_mm.z, 55, 1e-3) << "twisted, it presses nothing";
  pad_->press(BTN_TRIGGER, true);
  EXPECT_NEAR(after(1000).position_mm.z, 55 - 0.6 * 70, 1e-3);
}

TEST_F(GamepadTest, AWheelTurnsTheFingerAndItsPedalPresses) {
  run(test::wheel());
  pad_->turn(ABS_X, 65535);
  pad_->turn(ABS_HAT0Y, -1);
  const glm::dvec3 place = after(300).position_mm;
  EXPECT_NEAR(place.x, 95, 1e-3);
  EXPECT_NEAR(place.y, 30, 0.5) << "the hat moves it up";
  EXPECT_NEAR(place.z, 55, 1e-3) << "pedals that stand at their upper end are not pressed";
  pad_->turn(ABS_Z, 0);
  EXPECT_NEAR(after(1000).position_mm.z, -15, 1e-2);
}

// Until the first report, hid-lg4ff reports 0 for the pedal.
TEST_F(GamepadTest, AWheelsPedalIsKnownByTheFirstPositionThatItTells) {
  PadFacts facts = test::wheel();
  for (const unsigned code : {ABS_Y, ABS_Z, ABS_RZ}) facts.ranges[code].value = 0;
  PadControls controls(facts);
  EXPECT_EQ(controls.pull(), 0);
  controls.take({.time = {}, .type = EV_ABS, .code = ABS_Z, .value = 250});
  EXPECT_NEAR(controls.pull(), 5 / 255.0, 1e-9);
  controls.take({.time = {}, .type = EV_ABS, .code = ABS_Z, .value = 0});
  EXPECT_EQ(controls.pull(), 1);
}

TEST_F(GamepadTest, TheFirstTwoButtonsOfAJoystickAreMainAndClutch) {
  run(test::joystick());
  pad_->press(BTN_THUMB, true);
  EXPECT_EQ(after(1).buttons, 1U);
  pad_->press(BTN_THUMB2, true);
  EXPECT_EQ(after(1).buttons, 3U);
  pad_->press(BTN_THUMB, false);
  EXPECT_EQ(after(1).buttons, 2U);
}

// They are keys: "back" must not be a clutch, too.
TEST_F(GamepadTest, AGamepadsButtonsAreNotTheFingers) {
  run(test::xboxPad());
  for (const int button : {BTN_SOUTH, BTN_EAST, BTN_TL, BTN_TR}) pad_->press(static_cast<std::uint16_t>(button), true);
  EXPECT_EQ(after(1).buttons, 0U);
  EXPECT_NEAR(after(1000).position_mm.z, 55, 1e-3);
}

TEST_F(GamepadTest, AfterDroppedEventsItsStateIsAskedForAnew) {
  PadFacts facts = test::xboxPad();
  facts.keys.put(BTN_THUMB);
  run(facts);
  pad_->press(BTN_THUMB, true);
  EXPECT_EQ(after(1).buttons, 1U);
  pad_->down.put(BTN_THUMB, false);
  pad_->facts.ranges[ABS_RZ].value = 51;
  pad_->say(EV_SYN, SYN_DROPPED, 0);
  pad_->say(EV_ABS, ABS_RZ, 255);
  pad_->say(EV_SYN, SYN_REPORT, 0);
  const HapticSample sample = after(1000);
  EXPECT_EQ(sample.buttons, 0U);
  EXPECT_NEAR(sample.position_mm.z, 55 - 14, 0.01);
}

TEST_F(GamepadTest, AContactIsPlayedInTheSameTickAndStopsWithTheForce) {
  run(test::xboxPad());
  EXPECT_EQ(pad_->gain, 0xffff);
  EXPECT_FALSE(pad_->pushes());
  push({0, 0, 2}, 100);
  ASSERT_NE(pad_->playing(FF_RUMBLE), nullptr);
  EXPECT_NEAR(pad_->playing(FF_RUMBLE)->u.rumble.strong_magnitude, 65535 / 2, 0.02 * 65535 / 2);
  push({0, 0, 0});
  EXPECT_FALSE(pad_->pushes());
  ASSERT_NE(device_->contactDelays(), nullptr);
  EXPECT_EQ(device_->contactDelays()->count(), 1U);
  push({0, 0, 1});
  EXPECT_EQ(device_->contactDelays()->count(), 2U);
}

TEST_F(GamepadTest, ALevelThatStaysIsUploadedOnceAndPlayedAgainBeforeItEnds) {
  run(test::joystick());
  push({0.5, 0, 0});
  const int uploads = pad_->uploads;
  push({0.5, 0, 0}, 1600);
  EXPECT_EQ(pad_->uploads, uploads);
  EXPECT_EQ(pad_->effects[0].plays, 4) << "at 0, 500, 1000 and 1500 ms";
}

// Pads over Bluetooth take no more: hid-nintendo's queue of eight packets overflows otherwise.
TEST_F(GamepadTest, ARumbleThatChangesIsUploadedThirtyTimesASecondButBeginsAndEndsAtOnce) {
  run(test::xboxPad());
  for (int contact = 0; contact < 3; ++contact) {
    const int before = pad_->uploads;
    push({0, 0, 2});
    EXPECT_TRUE(pad_->pushes());
    for (int i = 0; i < 320; ++i) {
      push({0, 0, 2 + std::sin(0.05 * i)});
      const double strong = pad_->playing(FF_RUMBLE)->u.rumble.strong_magnitude / 65535.0;
      ASSERT_NEAR(strong, (2 + std::sin(0.05 * (i - 16))) / 4, 0.21) << i << ": of 32 ms ago at most";
    }
    EXPECT_LE(pad_->uploads - before, 12);
    push({0, 0, 0});
    EXPECT_FALSE(pad_->pushes());
  }
}

TEST_F(GamepadTest, AWheelsCentringIsOffWhileItRunsAndFullAfterwards) {
  run(test::wheel());
  EXPECT_EQ(pad_->centring, 0);
  push({1, 0, 0});
  EXPECT_NE(pad_->playing(FF_SPRING), nullptr);
  device_->stop();
  EXPECT_EQ(pad_->centring, 0xffff);
  EXPECT_FALSE(pad_->hasEffects()) << "erased";
  ASSERT_TRUE(device_->start());
  EXPECT_EQ(pad_->centring, 0);
  device_->close();
  EXPECT_EQ(pad_->centring, 0xffff);
}

TEST_F(GamepadTest, WhatTheDeviceHasNoRoomForIsNotUsed) {
  PadFacts facts = test::wheel();
  facts.effects_at_once = 1;
  run(facts);
  push({2, 0, 0});
  ASSERT_NE(pad_->playing(FF_CONSTANT), nullptr);
  EXPECT_NEAR(pad_->playing(FF_CONSTANT)->u.constant.level, -32767 / 2, 0.02 * 32767 / 2);
  EXPECT_EQ(pad_->playing(FF_SPRING), nullptr);
}

TEST_F(GamepadTest, OneThatTakesNoEffectSaysSoAndIsAsItWas) {
  pad_->facts = test::wheel();
  ASSERT_TRUE(device_->open() && device_->home());
  pad_->refuses = true;
  EXPECT_EQ(device_->start().error().code, ErrorCode::Io);
  EXPECT_EQ(device_->state(), HapticDevice::State::Ready);
  EXPECT_EQ(pad_->centring, 0xffff);
}

TEST_F(GamepadTest, UnpluggedItIsLostAndComesBackSilent) {
  run(test::xboxPad());
  push({0, 0, 2}, 10);
  pad_->plugged = false;
  clock_.advance(1ms);
  EXPECT_EQ(device_->read().error().code, ErrorCode::Lost);
  device_->close();
  EXPECT_EQ(device_->open().error().code, ErrorCode::NotFound);
  pad_->plugged = true;
  ASSERT_TRUE(device_->open() && device_->home() && device_->start());
  EXPECT_FALSE(pad_->pushes());
  push({0, 0, 2});
  EXPECT_TRUE(pad_->pushes());
}

TEST_F(GamepadTest, WhatItIsNotIsSaidOnceInOneLine) {
  testing::internal::CaptureStderr();
  run(test::xboxPad());
  device_->close();
  run(test::xboxPad());
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
  EXPECT_NE(said.find("not a 1 kHz three-axis device"), std::string::npos) << said;
}

// The whole task on a slope: with the trigger pulled all the way, the finger comes to rest where the trigger's force
// and the surface's are equal.
TEST_F(GamepadTest, OnTheHapticTaskItComesToRestOnASlope) {
  run(test::xboxPad());
  const DisplayVolume volume{160, 107, 40};
  RelievoMethod method({.stiffness_n_per_mm = 0.5});
  HapticTask task(*device_, method, clock_, volume, SafetyLimits{}, 0.5);
  std::vector<Frame> frames;
  for (int i = 0; i < 6; ++i) {
    frames.push_back(test::makeReliefFrame(180, 120, volume, mediaTime(0.04 * i),
                                           [](double x, double y) { return 20 + 0.15 * x - 0.1 * y; }));
  }
  task.windowToFill() = test::makeWindow(frames, volume);
  task.windowToFill().ended = true;
  task.windowToFill().clock = {.media = {}, .monotonic = clock_.now(), .rate = 1};
  task.publishWindow();
  std::vector<double> strong;
  std::uint64_t index = 0;
  for (int i = 0; i < 1500; ++i) {
    if (i == 100) pad_->turn(ABS_RZ, 255);
    clock_.advance(1ms);
    ASSERT_EQ(task.loop({index++, clock_.now(), clock_.now()}), LoopControl::Continue);
    const ff_effect* const rumble = pad_->playing(FF_RUMBLE);
    strong.push_back(rumble == nullptr ? 0 : rumble->u.rumble.strong_magnitude / 65535.0);
  }
  EXPECT_EQ(strong[250], 0) << "on its way";
  // Along the surface's normal n the surface gives 0.5 N/mm; the trigger 0.1 N/mm in depth. At x = y = 0, where the
  // surface is at 20: F n_z = 0.1 (z + 15), F = 0.5 n_z (20 - z).
  const double nz2 = 1 / (1 + 0.15 * 0.15 + 0.1 * 0.1);
  const double z = (0.5 * nz2 * 20 - 0.1 * 15) / (0.1 + 0.5 * nz2), force_n = 0.5 * std::sqrt(nz2) * (20 - z);
  for (std::size_t i = 400; i < strong.size(); ++i) EXPECT_NEAR(strong[i], force_n / 4, 0.02 * force_n / 4) << i;
}

TEST(Pads, AreToldByTheirStickAndForceAlone) {
  EXPECT_TRUE(isPad(test::xboxPad()));
  EXPECT_TRUE(isPad(test::wheel()));
  EXPECT_TRUE(isPad(test::joystick()));
  PadFacts silent = test::xboxPad();
  silent.forces = {};
  EXPECT_FALSE(isPad(silent));
  PadFacts phone = test::padFacts({FF_RUMBLE}, {});
  EXPECT_FALSE(isPad(phone)) << "a vibrator has no stick";
  PadFacts without_effects = test::xboxPad();
  without_effects.effects_at_once = 0;
  EXPECT_FALSE(isPad(without_effects));
}

}  // namespace
}  // namespace relievo
