// SPDX-License-Identifier: Apache-2.0
// The pointer on nodes of /dev/input that umockdev simulates: libevdev finds the mouse, read(2) reads its events.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <utility>

#include "drivers/pointer/pointer.h"
#include "platform/allocation_counter.h"
#include "tests/support/device/mocked_machine.h"
#include "tests/support/device/umockdev_mouse.h"

namespace relievo {
namespace {

using State = HapticDevice::State;
using test::UmockdevMouse;

class PointerEvdev : public test::MockedMachine {
 protected:
  std::unique_ptr<HapticDevice> run(const std::string& path = {}) {
    auto device = makePointer(path, clock_);
    const auto opened = device->open();
    EXPECT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(device->home());
    const auto started = device->start();
    EXPECT_TRUE(started) << started.error().message;
    return device;
  }
  // Ticks in simulated time until the condition holds: an event takes the kernel a moment to deliver.
  static constexpr int kPatience = 5000;
  HapticSample until(HapticDevice& device, const std::function<bool(const HapticSample&)>& so) {
    HapticSample sample;
    for (int i = 0; i < kPatience; ++i) {
      clock_.advance(std::chrono::milliseconds(1));
      const auto read = device.read();
      EXPECT_TRUE(read) << read.error().message;
      if (!read) break;
      sample = *read;
      if (so(sample)) return sample;
      MonotonicClock real;
      real.sleepUntil(real.now() + std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "the condition never held";
    return sample;
  }

  ManualClock clock_;
};

TEST_F(PointerEvdev, FindsTheFirstMouseAmongOtherDevicesAndFollowsIt) {
  UmockdevMouse keys(bed_, 0, UmockdevMouse::keyboard()), mouse(bed_, 3, UmockdevMouse::mouse());
  UmockdevMouse second(bed_, 12, UmockdevMouse::mouse());
  const auto device = run();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(device->read()->position_mm, glm::dvec3(0, 0, 46)) << "it does not wait";
  mouse.say(EV_REL, REL_X, 120);
  mouse.say(EV_REL, REL_Y, -60);
  mouse.say(EV_KEY, BTN_MIDDLE, 1);
  mouse.say(EV_SYN, SYN_REPORT, 0);
  until(*device, [](const HapticSample& sample) {
    return sample.buttons == 1 && glm::distance(sample.position_mm, glm::dvec3(12, 6, 46)) < 1e-6;
  });
  EXPECT_EQ(mouse.unknownRequests(), 0);
}

TEST_F(PointerEvdev, AsksForTheButtonsAfterDroppedEvents) {
  UmockdevMouse mouse(bed_, 3, UmockdevMouse::mouse());
  mouse.hold(BTN_RIGHT, true);
  const auto device = run("/dev/input/event3");
  EXPECT_EQ(device->read()->buttons, 2u) << "held when it began";
  mouse.hold(BTN_RIGHT, false);
  mouse.say(EV_SYN, SYN_DROPPED, 0);
  mouse.say(EV_SYN, SYN_REPORT, 0);
  until(*device, [](const HapticSample& sample) { return sample.buttons == 0; });
}

TEST_F(PointerEvdev, ATickOnTheRealNodeAllocatesNothing) {
  UmockdevMouse mouse(bed_, 3, UmockdevMouse::mouse());
  const auto device = run();
  for (int i = 0; i < 50; ++i) {
    mouse.say(EV_REL, REL_X, 1);
    mouse.say(EV_SYN, SYN_REPORT, 0);
  }
  const std::uint64_t before = threadAllocations();
  std::uint64_t in_ticks = 0;
  until(*device, [&](const HapticSample& sample) {
    (void)device->write({0, 0, 1});
    in_ticks = threadAllocations();
    return std::abs(sample.position_mm.x - 5) < 1e-6;
  });
  EXPECT_EQ(in_ticks, before);
}

TEST_F(PointerEvdev, UnpluggedInUseItIsLostAndItsPlaceIsNotFound) {
  UmockdevMouse mouse(bed_, 3, UmockdevMouse::mouse());
  const auto device = run();
  ASSERT_TRUE(device->read());
  mouse.unplug();
  MonotonicClock real;
  for (int i = 0; i < kPatience && device->state() == State::Running; ++i) {
    (void)device->read();
    real.sleepUntil(real.now() + std::chrono::milliseconds(1));
  }
  EXPECT_EQ(device->state(), State::Lost);
  device->close();
  EXPECT_EQ(device->open().error().code, ErrorCode::NotFound);
}

// Two fingers: each has a mouse of its own, also where neither says which.
TEST_F(PointerEvdev, AMouseIsOneFingerAlone) {
  UmockdevMouse first(bed_, 3, UmockdevMouse::mouse()), other(bed_, 12, UmockdevMouse::mouse());
  const auto left = run(), right = run();
  for (const auto& [mouse, x_mm] : {std::pair(&first, 100), std::pair(&other, -200)}) {
    mouse->say(EV_REL, REL_X, x_mm);
    mouse->say(EV_SYN, SYN_REPORT, 0);
  }
  until(*left, [](const HapticSample& sample) { return std::abs(sample.position_mm.x - 10) < 1e-6; });
  until(*right, [](const HapticSample& sample) { return std::abs(sample.position_mm.x + 20) < 1e-6; });
  for (const char* path : {"", "/dev/input/event3"}) {
    EXPECT_STREQ(makePointer(path, clock_)->open().error().message,
                 "the mouse is already a finger, or another program has it for itself; plug in another one, or end "
                 "that program");
  }
  left->close();
  EXPECT_TRUE(makePointer("", clock_)->open());
}

// As those that map keys do, which make up another mouse for what they let through.
TEST_F(PointerEvdev, AMouseThatAnotherProgramHasForItselfIsPassedOver) {
  UmockdevMouse first(bed_, 3, UmockdevMouse::mouse());
  first.letOthersGrab();
  EXPECT_THAT(makePointer("", clock_)->open().error().message, testing::HasSubstr("another program has it"));
  UmockdevMouse made_up(bed_, 12, UmockdevMouse::mouse());
  const auto device = run();
  EXPECT_FALSE(made_up.isGrabbed());
  made_up.say(EV_REL, REL_X, 100);
  made_up.say(EV_SYN, SYN_REPORT, 0);
  until(*device, [](const HapticSample& sample) { return std::abs(sample.position_mm.x - 10) < 1e-6; });
}

TEST_F(PointerEvdev, WhatIsNoMouseIsRefused) {
  UmockdevMouse keys(bed_, 0, UmockdevMouse::keyboard());
  EXPECT_EQ(makePointer("/dev/input/event0", clock_)->open().error().code, ErrorCode::Unsupported);
  EXPECT_EQ(makePointer("/dev/input/event9", clock_)->open().error().code, ErrorCode::NotFound);
  EXPECT_EQ(makePointer("", clock_)->open().error().code, ErrorCode::NotFound);
}

TEST_F(PointerEvdev, OnlyAMouseThatMayNotBeOpenedLacksAPermission) {
  if (sizeof(long) != 8) GTEST_SKIP() << "words of 32 bits";
  const auto told = [this](const char* keys, const char* axes) {
    return toldOfAClosedNode({{"key", keys}, {"rel", axes}},
                             [this] { return std::string(makePointer("", clock_)->open().error().message); });
  };
  EXPECT_THAT(told("10000 402000000 3803078f800d001 feffffdfffefffff fffffffffffffffe", "0"),
              testing::StartsWith("no mouse was found"))
      << "a keyboard";
  EXPECT_THAT(told("e520 10000 0 0 0 0", "0"), testing::StartsWith("no mouse was found")) << "a touchpad";
  EXPECT_THAT(told("1f0000 0 0 0 0", "1943"), testing::StartsWith("no permission to read the mouse"));
}

}  // namespace
}  // namespace relievo
