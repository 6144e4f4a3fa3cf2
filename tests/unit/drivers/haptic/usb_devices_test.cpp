// SPDX-License-Identifier: Apache-2.0
// Tests of every haptic device over USB, on a model in simulated time: whatever happens to the cable, the device
// applies no force that was not requested.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <glm/geometric.hpp>
#include <random>

#include "tests/support/device/model_port.h"
#include "tests/support/device/usb/usb_kinds.h"

namespace relievo {
namespace {

using test::Cable;
using test::HapticModel;
using test::UsbKind;
using State = HapticDevice::State;

constexpr Duration kTick = std::chrono::milliseconds(1);

class UsbDevice : public testing::TestWithParam<UsbKind> {
 protected:
  HapticModel& model() { return *bench_.model; }
  std::unique_ptr<HapticDevice> make() {
    return bench_.driver(std::make_unique<test::ModelPort>(model(), cable_, clock_), clock_);
  }
  // Returns a Running device with the hand at rest.
  std::unique_ptr<HapticDevice> run() {
    auto device = make();
    EXPECT_TRUE(device->open() && device->home());
    clock_.advance(std::chrono::milliseconds(100));
    EXPECT_TRUE(device->start());
    clock_.advance(kTick);
    for (int i = 0; i < 3; ++i) (void)tick(*device, {});
    return device;
  }
  Result<HapticSample> tick(HapticDevice& device, const glm::dvec3& force_n) {
    auto sample = device.read();
    EXPECT_TRUE(!sample || device.write(force_n));
    clock_.advance(kTick);
    return sample;
  }
  // Writes a force until it has faded in.
  void push(HapticDevice& device) {
    for (int i = 0; i < 600; ++i) (void)tick(device, {0, 0, 3});
    EXPECT_TRUE(pushes());
  }
  // The hand's position when the last command was answered.
  glm::dvec3 whereAnswered() { return model().gripNow(clock_.now() - kTick + GetParam().answers_in); }
  bool pushes() { return model().pushes(clock_.now()); }
  glm::dvec3 felt() { return model().forceAt(GetParam().rest_mm, clock_.now()); }

  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  Cable cable_;
  test::UsbBench bench_ = GetParam().make();
};
INSTANTIATE_TEST_SUITE_P(Kinds, UsbDevice, testing::ValuesIn(test::usbKinds().begin(), test::usbKinds().end()),
                         [](const auto& test) { return std::string(test.param.name); });

// Cancelled at the first call of the port, at the second, and so on: while the firmware is loaded, while nobody helps
// it to home, and when there is nothing to wait for.
TEST_P(UsbDevice, OpeningAndHomingEndSoonWhenTheyAreCalledOff) {
  for (const bool helped : {true, false}) {
    if (!helped) {  // it moves, but not to where its zero is
      model().grip = [](double t_s) { return GetParam().rest_mm + glm::dvec3(0, 2 * std::sin(9 * t_s), 0); };
    }
    const auto live = [](HapticDevice& device) {
      auto opened = device.open();
      return opened ? device.home() : opened;
    };
    for (int moment = 1; moment < 2500; moment += helped ? 1 : 400) {
      model().powerOn();
      const auto device = make();
      cable_ = Cable{.instead = [&device] { device->cancel(); }, .verbs_left = moment};
      const auto lived = live(*device);
      if (lived && helped) break;
      ASSERT_EQ(lived.error().code, ErrorCode::Cancelled) << moment;
      ASSERT_LE(clock_.now() - cable_.pulled_at, std::chrono::milliseconds(100)) << moment;
      ASSERT_FALSE(!helped && model().homed()) << moment;
      if (moment % 50 != 1) continue;
      device->close();
      ASSERT_TRUE(device->open()) << "closing resets the cancellation";
    }
  }
}

TEST_P(UsbDevice, ThePositionIsTheHandsWithinACount) {
  const auto device = run();
  model().grip = [](double t_s) {
    return GetParam().rest_mm +
           glm::dvec3(30 * std::sin(2 * t_s), 25 * std::sin(3 * t_s + 1), 30 * std::sin(1.3 * t_s));
  };
  for (int i = 0; i < 20; ++i) (void)tick(*device, {});
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 answered = whereAnswered();
    const auto sample = tick(*device, {});
    ASSERT_TRUE(sample);
    worst = std::max(worst, glm::distance(sample->position_mm, answered));
  }
  EXPECT_LT(worst, 0.1) << "half a count of each joint";
}

TEST_P(UsbDevice, TheFirstTickKnowsWhereTheHandIs) {
  const auto device = make();
  ASSERT_TRUE(device->open() && device->home());
  clock_.advance(std::chrono::milliseconds(100));
  const glm::dvec3 homed = model().gripNow(clock_.now() - std::chrono::milliseconds(100));
  model().grip = [homed](double) { return homed + glm::dvec3(0.12, 0.06, 0); };
  ASSERT_TRUE(device->start());
  clock_.advance(kTick);
  EXPECT_LT(glm::distance(device->read()->position_mm, model().gripNow(clock_.now())), 0.06);
}

TEST_P(UsbDevice, AfterLostAnswersTheFirstOneIsBelieved) {
  int lost = 0, seen = 0;
  const auto device = run();
  model().grip = [](double t_s) {  // 0.4 m/s
    return GetParam().rest_mm + glm::dvec3(10 * std::sin(40 * t_s), 0, 0);
  };
  for (int i = 0; i < 10; ++i) (void)tick(*device, {});
  model().spoil = [&](std::vector<std::uint8_t>& bytes) {
    if (++lost % 7 > 1) bytes.clear();
  };
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 answered = whereAnswered();
    seen += glm::distance(tick(*device, {})->position_mm, answered) < 0.1 ? 1 : 0;
  }
  EXPECT_GT(seen, 270) << "two of seven";
}

TEST_P(UsbDevice, TheForceReachesTheHand) {
  const auto device = run();
  push(*device);
  for (const glm::dvec3& force :
       {glm::dvec3(2, 0, 0), glm::dvec3(0, -3, 0), glm::dvec3(1, 1, -2), glm::dvec3(0, 0, 5)}) {
    (void)tick(*device, force);
    // Half a milliamp of a Polhem's body a: 0.321 x 16 N m/A on 0.22 m, 0.012 N.
    EXPECT_LT(glm::distance(felt(), force), 0.015);
  }
}

TEST_P(UsbDevice, TheForceFadesInAfterStart) {
  const auto device = run();
  for (int start = 0; start < 2; ++start) {
    double before = 0;
    for (int i = 0; i < 500; ++i) {
      (void)tick(*device, {0, 0, 4});
      ASSERT_LE(felt().z - before, 0.05) << "4 N in half a second are 8 mN a tick, and a command's rounding";
      before = felt().z;
    }
    EXPECT_NEAR(before, 4, 0.05);
    device->stop();
    ASSERT_TRUE(device->start());
  }
}

// Answers have no checksum. The driver must reject positions that no hand could have reached (see EncoderGate), and
// must never send a force beyond the device's limit.
TEST_P(UsbDevice, CorruptSplitAndLostAnswersMakeNoWrongPositionAndNoWildForce) {
  std::mt19937 random(99);
  int spoiled = 0;
  std::vector<std::uint8_t> late;
  const auto device = run();
  push(*device);
  model().grip = [](double t_s) {
    return GetParam().rest_mm + glm::dvec3(20 * std::sin(4 * t_s), 20 * std::sin(5 * t_s), 20 * std::sin(3 * t_s));
  };
  for (int i = 0; i < 50; ++i) (void)tick(*device, {});
  model().spoil = [&](std::vector<std::uint8_t>& bytes) {
    if (random() % 4 == 0) ++spoiled, GetParam().spoil(bytes, late, random);
    else if (!late.empty()) bytes.insert(bytes.begin(), late.begin(), late.end()), late.clear();
  };
  const double peak_n = device->capabilities().peak_force_n;
  std::deque<glm::dvec3> answered;
  double worst = 0;
  int held = 0;
  for (int i = 0; i < 10'000; ++i) {
    answered.push_front(whereAnswered());
    if (answered.size() > 20) answered.pop_back();
    const auto sample = tick(*device, {0, 0, peak_n});
    ASSERT_TRUE(sample) << sample.error().message;
    const auto off = [&](const glm::dvec3& place) { return glm::distance(place, sample->position_mm); };
    double nearest = 1e9;
    for (const glm::dvec3& place : answered) nearest = std::min(nearest, off(place));
    worst = std::max(worst, nearest);
    held += off(answered.front()) > 0.15 ? 1 : 0;
    ASSERT_LE(glm::length(model().forceAt(answered.front(), clock_.now())), peak_n + 0.1) << i;
  }
  EXPECT_GT(spoiled, 2000);
  EXPECT_LT(worst, 0.5) << "0.15 mm a tick, after three in a row without an answer";
  EXPECT_LT(held, 4000);
}

TEST_P(UsbDevice, IsLostWhenItSaysNothingAnyMore) {
  const auto device = run();
  model().silence();
  int ticks = 0;
  while (device->state() == State::Running && ticks < 1000) (void)tick(*device, {0, 0, 1}), ++ticks;
  EXPECT_EQ(device->state(), State::Lost);
  EXPECT_NEAR(ticks, 101, 2);
}

TEST_P(UsbDevice, IsLostWhenItFallsSilentWhileItIsHomed) {
  const auto device = make();
  ASSERT_TRUE(device->open());
  model().silence();
  const MonotonicTime before = clock_.now();
  EXPECT_EQ(device->home().error().code, ErrorCode::Lost);
  EXPECT_EQ(device->state(), State::Lost);
  EXPECT_LE(clock_.now() - before, std::chrono::milliseconds(102));
}

TEST_P(UsbDevice, AForceThatNobodyRenewsEnds) {
  const auto device = run();
  push(*device);
  clock_.advance(std::chrono::milliseconds(18));
  ASSERT_TRUE(device->read());
  EXPECT_TRUE(pushes()) << "one late tick is not yet a reason";
  clock_.advance(std::chrono::milliseconds(4));
  ASSERT_TRUE(device->read());
  EXPECT_FALSE(pushes());
  ASSERT_TRUE(device->write({0, 0, 3}));
  EXPECT_LT(felt().z, 0.3) << "it fades in again";
}

TEST_P(UsbDevice, AHandThatIsNotSeenIsNotPushed) {
  bool seen = false;
  const auto device = run();
  push(*device);
  model().spoil = [&](std::vector<std::uint8_t>& bytes) {
    if (!seen) bytes.clear();
  };
  for (int i = 0; i < 20; ++i) (void)tick(*device, {0, 0, 3});
  EXPECT_NEAR(felt().z, 3, 0.05) << "some lost answers are not yet a reason";
  for (int i = 0; i < 30; ++i) (void)tick(*device, {0, 0, 3});
  EXPECT_LT(felt().z, 0.03);
  seen = true;
  for (int i = 0; i < 100; ++i) (void)tick(*device, {0, 0, 3});
  EXPECT_NEAR(felt().z, 0.6, 0.05) << "it fades in again";
}

TEST_P(UsbDevice, WhatDoesNotTakeItsZeroGetsItAgain) {
  const auto device = run();
  push(*device);
  cable_.deaf = true;
  for (int i = 0; i < 30; ++i) (void)tick(*device, {0, 0, 3});
  cable_.deaf = false;
  EXPECT_TRUE(pushes()) << "the device did not take the command";
  ASSERT_TRUE(device->read());
  EXPECT_FALSE(pushes());
}

TEST_P(UsbDevice, ForceIsZeroAfterStopCloseAndTheEnd) {
  auto device = run();
  push(*device);
  device->stop();
  EXPECT_FALSE(pushes());
  ASSERT_TRUE(device->start());
  push(*device);
  device->close();
  EXPECT_FALSE(pushes());
  EXPECT_FALSE(cable_.open || cable_.exchanging);
  device.reset();
  model().powerOn();
  device = run();
  push(*device);
  device.reset();
  EXPECT_FALSE(pushes());
}

// The cable is unplugged at the first call of the port, then at the second, and so on through a whole session; after
// plugging it in again everything works.
TEST_P(UsbDevice, UnpluggedAtAnyMomentItIsCleanAndComesBack) {
  const auto live = [&](HapticDevice& device) -> Result<void> {
    if (auto opened = device.open(); !opened) return opened;
    if (auto homed = device.home(); !homed) return homed;
    if (auto started = device.start(); !started) return started;
    for (int i = 0; i < 30; ++i) {
      clock_.advance(kTick);
      if (auto sample = device.read(); !sample) return std::unexpected(sample.error());
      if (auto written = device.write({0, 0, 1}); !written) return written;
    }
    device.stop();
    return {};
  };
  int moment = 1;
  for (bool whole = false; !whole; ++moment) {
    model().powerOn();
    cable_ = Cable{.verbs_left = moment};
    const auto device = make();
    const auto lived = live(*device);
    whole = lived.has_value();
    if (!whole) {
      ASSERT_TRUE(lived.error().code == ErrorCode::Lost || lived.error().code == ErrorCode::NotFound) << moment;
      ASSERT_LE(clock_.now() - cable_.pulled_at, std::chrono::milliseconds(100)) << moment;
    }
    device->close();
    ASSERT_EQ(device->state(), State::Closed);
    ASSERT_FALSE(cable_.open || cable_.exchanging) << moment;
    // Most moments of a wait are alike, so only some of them are tested fully.
    if (moment % 7 != 0 && moment > 40) continue;
    cable_ = Cable{};
    model().powerOn();
    const auto again = live(*device);
    ASSERT_TRUE(again) << moment << ": " << again.error().message;
    device->close();
  }
  EXPECT_GT(moment, 300);
}

}  // namespace
}  // namespace relievo
