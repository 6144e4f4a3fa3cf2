// SPDX-License-Identifier: Apache-2.0
// The whole driver on a gamepad and a wheel that the kernel creates (uinput): what is uploaded, and that nothing plays
// on. toolchain/guest runs this in a virtual machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <optional>

#include "drivers/gamepad/gamepad.h"
#include "drivers/gamepad/pad_list.h"
#include "tests/support/device/fake_pad.h"
#include "tests/support/device/uinput_pad.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::UinputPad;

class GamepadUinput : public testing::Test {
 protected:
  void SetUp() override {
    if (!UinputPad::canBeMade()) GTEST_SKIP() << "/dev/uinput is not there; toolchain/guest has one";
  }
  // A tick every millisecond, until that time has passed.
  static void push(HapticDevice& device, const glm::dvec3& force_n, Duration time) {
    MonotonicClock clock;
    const MonotonicTime began = clock.now();
    for (MonotonicTime next = began; next < began + time; next += 1ms) {
      clock.sleepUntil(next);
      if (!device.read() || !device.write(force_n)) return;
    }
  }
  // At most five seconds.
  bool until(const std::function<bool()>& so) {
    for (const MonotonicTime last = clock_.now() + 5s; clock_.now() < last; clock_.sleepUntil(clock_.now() + 1ms)) {
      if (so()) return true;
    }
    return so();
  }
  void run(HapticDevice& device) {
    const auto opened = device.open();
    ASSERT_TRUE(opened) << opened.error().message;
    ASSERT_TRUE(device.home());
    const auto started = device.start();
    ASSERT_TRUE(started) << started.error().message;
  }

  MonotonicClock clock_;
};

TEST_F(GamepadUinput, APadsRumbleIsTheForceAndStopsWithIt) {
  PadFacts keyboard = test::padFacts({}, {KEY_A, KEY_ENTER});
  const UinputPad other(keyboard), pad(test::xboxPad());
  auto device = makeGamepad("", clock_);
  run(*device);
  EXPECT_EQ(pad.gain(), 0xffff);
  EXPECT_FALSE(pad.plays());
  for (const glm::dvec3& force_n : {glm::dvec3(0, 0, 0.2), glm::dvec3(0.6, 0, 0.8), glm::dvec3(0, -1.2, 3.2)}) {
    SCOPED_TRACE(force_n.z);
    push(*device, force_n, 900ms);
    const UinputPad::Effect rumble = pad.effect(FF_RUMBLE);
    EXPECT_TRUE(rumble.playing);
    const double strong = 65535 * glm::length(force_n) / 4, weak = 65535 * glm::length(glm::dvec2(force_n)) / 4;
    EXPECT_NEAR(rumble.level.u.rumble.strong_magnitude, strong, 0.02 * strong);
    EXPECT_NEAR(rumble.level.u.rumble.weak_magnitude, weak, 0.02 * weak + 8);
    push(*device, {}, 100ms);
    EXPECT_FALSE(pad.plays());
  }
  EXPECT_EQ(device->contactDelays()->count(), 3U);
  EXPECT_LT(device->contactDelays()->max(), 10ms);
  push(*device, {0, 0, 2}, 50ms);
  EXPECT_TRUE(pad.plays());
  EXPECT_TRUE(until([&] { return !pad.plays(); })) << "no force comes any more";
  push(*device, {0, 0, 2}, 50ms);
  device->stop();
  EXPECT_FALSE(pad.hasEffects());
}

// The push to the right. A constant force has the direction and the level that the kernel's documentation defines; a
// spring pushes with its coefficient times the distance to its centre.
double pushOf(const UinputPad& wheel, double place) {
  const auto constant = wheel.effect(FF_CONSTANT), spring = wheel.effect(FF_SPRING);
  double push = 0;
  if (constant.playing) {
    push -=
        std::sin(2 * std::numbers::pi * constant.level.direction / 65536.0) * constant.level.u.constant.level / 32767.0;
  }
  if (spring.playing) {
    const ff_condition_effect& x = spring.level.u.condition[0];
    const double way = x.center / 32767.0 - place;
    push += way * (way < 0 ? x.right_coeff : x.left_coeff) / 32767.0;
  }
  return push;
}

TEST_F(GamepadUinput, AWheelPushesWithTheForceAlongItsAxisAndCentresItselfAgainInTheEnd) {
  const UinputPad wheel(test::wheel());
  auto device = makeGamepad(wheel.node(), clock_);
  run(*device);
  EXPECT_EQ(wheel.centring(), 0);
  for (const int turned : {32768, 5000, 65000}) {
    wheel.turn(ABS_X, turned);
    for (const double force_n : {-3.0, -0.3, 0.3, 1.0, 4.0}) {
      SCOPED_TRACE(testing::Message() << force_n << " N at " << turned);
      push(*device, {force_n, 0, 0}, 60ms);
      const double place = 2 * turned / 65535.0 - 1;
      EXPECT_TRUE(until([&] { return std::abs(pushOf(wheel, place) - force_n / 4) < 0.02 * std::abs(force_n) / 4; }))
          << pushOf(wheel, place);
    }
  }
  device->close();
  EXPECT_FALSE(wheel.hasEffects());
  EXPECT_EQ(wheel.centring(), 0xffff);
}

// A program that pushes until it is killed.
pid_t beginPushing(const std::string& node) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  MonotonicClock clock;
  auto device = makeGamepad(node, clock);
  if (!device->open() || !device->home() || !device->start()) ::_exit(1);
  for (;;) {
    clock.sleepUntil(clock.now() + 1ms);
    if (!device->read() || !device->write({1, 0, 1})) ::_exit(2);
  }
}

TEST_F(GamepadUinput, AKilledProgramLeavesNothingPlaying) {
  for (const PadFacts& facts : {test::xboxPad(), test::wheel()}) {
    const UinputPad pad(facts);
    const pid_t child = beginPushing(pad.node());
    EXPECT_TRUE(until([&] { return pad.plays(); }));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_TRUE(until([&] { return !pad.hasEffects(); }));
    EXPECT_FALSE(pad.plays());
  }
}

TEST_F(GamepadUinput, AFatalSignalsHandlerSilencesAllThatIsOpen) {
  const UinputPad wheel(test::wheel());
  auto device = makeGamepad(wheel.node(), clock_);
  run(*device);
  push(*device, {1, 0, 0}, 30ms);
  EXPECT_TRUE(wheel.plays());
  quietenAllPads();
  EXPECT_TRUE(until([&] { return !wheel.plays() && wheel.centring() == 0xffff; }));
}

TEST_F(GamepadUinput, UnpluggedItIsLostAndComesBack) {
  std::optional<UinputPad> pad(std::in_place, test::xboxPad());
  auto device = makeGamepad("", clock_);
  run(*device);
  push(*device, {0, 0, 1}, 30ms);
  pad.reset();
  EXPECT_TRUE(until([&] { return !device->read() && device->state() == HapticDevice::State::Lost; }));
  device->close();
  EXPECT_EQ(device->open().error().code, ErrorCode::NotFound);
  pad.emplace(test::xboxPad());
  run(*device);
  EXPECT_FALSE(pad->plays());
  pad->turn(ABS_RZ, 255);
  push(*device, {0, 0, 1}, 30ms);
  EXPECT_TRUE(until([&] { return pad->plays(); }));
  EXPECT_LT(device->read()->position_mm.z, 54);
}

TEST_F(GamepadUinput, TheListSaysWhatEachCanDoAndWhatIsMissing) {
  EXPECT_FALSE(lookAtGamepads().at(0).there);
  EXPECT_THAT(lookAtGamepads().at(0).state, testing::HasSubstr("plug one in"));
  const UinputPad wheel(test::wheel());
  const auto seen = lookAtGamepads();
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].path, wheel.node());
  EXPECT_EQ(seen[0].state, "pad: constant force, spring, centring");
  const pid_t child = ::fork();
  if (child == 0) {  // a user without permission for the device
    const bool dropped = ::setgid(65534) == 0 && ::setuid(65534) == 0;
    const auto refused = lookAtGamepads();
    const bool told = !refused[0].there && refused[0].state.find("group input") != std::string::npos;
    ::_exit(dropped && told && refused[0].path == wheel.node() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST_F(GamepadUinput, APadWithoutForceFeedbackIsNamedWithWhatToDo) {
  PadFacts facts = test::xboxPad();
  facts.forces = {};
  facts.effects_at_once = 0;
  const UinputPad pad(facts);
  ASSERT_FALSE(pad.node().empty());
  const auto seen = lookAtGamepads();
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].path, pad.node());
  EXPECT_FALSE(seen[0].there);
  EXPECT_THAT(seen[0].state, testing::AllOf(testing::HasSubstr("no force feedback"), testing::HasSubstr("XInput")));
  for (const std::string& path : {std::string(), pad.node()}) {
    const auto opened = makeGamepad(path, clock_)->open();
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().message, testing::HasSubstr("XInput")) << path;
  }
}

}  // namespace
}  // namespace relievo
