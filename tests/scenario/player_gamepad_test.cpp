// SPDX-License-Identifier: Apache-2.0
// The whole player, as a program, on a gamepad and a wheel that the kernel creates (uinput): what is felt is played,
// and nothing in a pause, at the end and after a kill. toolchain/guest runs this in a virtual machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>

#include "platform/clock.h"
#include "tests/support/device/fake_pad.h"
#include "tests/support/device/uinput_pad.h"
#include "tests/support/film/slope.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::UinputPad;

class PlayerOnAGamepad : public testing::Test {
 protected:
  void SetUp() override {
    if (!UinputPad::canBeMade()) GTEST_SKIP() << "/dev/uinput is not there; toolchain/guest has one";
    test::makeSlope(folder_ / "slope.mkv", 5);  // few pictures, for a slow virtual machine
  }
  std::vector<std::string> play(const std::string& haptic, const std::vector<std::string>& more) {
    std::vector<std::string> words = {
        RELIEVO_BIN_DIR "/relievo", "play", folder_ / "slope.mkv", "--display", "mock", "--haptic", haptic, "--loop"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  // While the player runs, at most a minute.
  bool until(test::Process& player, const std::function<bool()>& so) {
    const MonotonicTime last = clock_.now() + 60s;
    for (; clock_.now() < last && player.isRunning(); clock_.sleepUntil(clock_.now() + 1ms)) {
      if (so()) return true;
    }
    return so();
  }
  // Whether the value stays the same to 1 % for a fifth of a second.
  bool stays(const std::function<double()>& value) {
    const double first = value();
    for (int i = 0; i < 20; ++i) {
      clock_.sleepUntil(clock_.now() + 10ms);
      if (std::abs(value() - first) > 0.01 * first) return false;
    }
    return true;
  }
  std::string said() {
    std::ifstream file(folder_ / "said.txt");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  const test::TemporaryFolder folder_;
  MonotonicClock clock_;
};

// The median of the forces that were sent: most of the time the finger is at rest on the slope.
double usualForce(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<double> forces_n;
  while (std::getline(file, line)) {
    std::istringstream row(line);
    std::vector<double> n;
    for (std::string cell; n.size() < 10 && std::getline(row, cell, ',');) n.push_back(std::stod(cell));
    const double force_n = std::sqrt(n[7] * n[7] + n[8] * n[8] + n[9] * n[9]);
    if (force_n > 0) forces_n.push_back(force_n);
  }
  if (forces_n.empty()) return 0;
  const auto middle = forces_n.begin() + static_cast<std::ptrdiff_t>(forces_n.size() / 2);
  std::ranges::nth_element(forces_n, middle);
  return *middle;
}

TEST_F(PlayerOnAGamepad, FeelsTheFilmInItsRumbleAndRestsInAPause) {
  UinputPad pad(test::xboxPad());
  PadFacts keys = test::padFacts({}, {KEY_LEFT, KEY_RIGHT, KEY_OK, KEY_PLAYPAUSE});
  keys.effects_at_once = 0;
  UinputPad remote(keys);
  test::Process player(
      play("gamepad", {"--remote", "evdev", "--report", folder_ / "r.json", "--record", folder_ / "t.csv"}),
      folder_ / "said.txt");
  ASSERT_TRUE(until(player, [&] { return pad.hasEffects(); })) << said();
  pad.turn(ABS_RZ, 255);  // presses
  ASSERT_TRUE(until(player, [&] { return pad.plays(); })) << said();
  const auto level = [&] { return pad.effect(FF_RUMBLE).level.u.rumble.strong_magnitude; };
  // A slow machine may have to buffer, and the force then fades; at rest on the slope it stays.
  EXPECT_TRUE(until(player, [&] { return level() > 0.5 * 65535 && stays(level); })) << said();
  const double strong = level();
  const auto pressPause = [&] {
    for (const bool down : {true, false}) remote.press(KEY_PLAYPAUSE, down);
  };
  pressPause();
  EXPECT_TRUE(until(player, [&] { return !pad.plays() && stays([&] { return pad.plays(); }); })) << "the pause";
  pressPause();
  EXPECT_TRUE(until(player, [&] { return pad.plays(); })) << "it goes on";
  player.send(SIGTERM);
  EXPECT_EQ(player.wait(), 0) << said();
  EXPECT_FALSE(pad.hasEffects());
  EXPECT_THAT(said(), testing::HasSubstr("not a 1 kHz three-axis device"));

  const double sent = 65535 * usualForce(folder_ / "t.csv") / 4;
  EXPECT_NEAR(strong, sent, 0.02 * sent);
  EXPECT_GT(sent, 0.5 * 65535);
  std::ifstream file(folder_ / "r.json");
  const auto report = nlohmann::json::parse(file);
  EXPECT_THAT(report["states"].dump(), testing::HasSubstr("paused")) << "what rested was no film that began again";
  EXPECT_EQ(report["haptic"]["device"], "gamepad");
  const double told_ns = report["haptic"]["contact_told_ns"]["max"].get<double>();
  EXPECT_GT(told_ns, 0);
  EXPECT_LT(told_ns, 10e6);
  std::printf("a contact is told after %.1f ms at most\n", 1e-6 * told_ns);
}

// The slope rises to the right and downwards, so that it pushes to the left.
TEST_F(PlayerOnAGamepad, AWheelIsPushedDownTheSlope) {
  UinputPad wheel(test::wheel());
  test::Process player(play("gamepad:" + wheel.node(), {}), folder_ / "said.txt");
  ASSERT_TRUE(until(player, [&] { return wheel.hasEffects(); })) << said();
  EXPECT_EQ(wheel.centring(), 0);
  wheel.turn(ABS_Z, 0);  // the pedal, all the way
  EXPECT_TRUE(until(player, [&] { return wheel.effect(FF_SPRING).playing; })) << said();
  const auto spring = wheel.effect(FF_SPRING).level.u.condition[0];
  EXPECT_LT(spring.center, 0) << "to the left of the wheel, which stands in the middle";
  EXPECT_EQ(spring.right_coeff, 0x7fff);
  EXPECT_EQ(spring.left_coeff, 0);
  player.send(SIGTERM);
  EXPECT_EQ(player.wait(), 0) << said();
  EXPECT_FALSE(wheel.hasEffects());
  EXPECT_EQ(wheel.centring(), 0xffff);
}

TEST_F(PlayerOnAGamepad, NothingPlaysOnHoweverItEnds) {
  for (const int number : {SIGSEGV, SIGKILL}) {
    SCOPED_TRACE(::strsignal(number));
    UinputPad pad(test::xboxPad());
    test::Process player(play("gamepad", {}), folder_ / "said.txt");
    ASSERT_TRUE(until(player, [&] { return pad.hasEffects(); })) << said();
    pad.turn(ABS_RZ, 255);
    ASSERT_TRUE(until(player, [&] { return pad.plays(); })) << said();
    player.send(number);
    EXPECT_EQ(player.wait(), -number);
    const MonotonicTime last = clock_.now() + 5s;
    while (pad.hasEffects() && clock_.now() < last) clock_.sleepUntil(clock_.now() + 1ms);
    EXPECT_FALSE(pad.hasEffects());
    EXPECT_FALSE(pad.plays());
  }
}

TEST_F(PlayerOnAGamepad, UnpluggedTheFilmPlaysOnAndItIsTakenAgain) {
  auto pad = std::make_unique<UinputPad>(test::xboxPad());
  test::Process player(play("gamepad", {"--report", folder_ / "r.json"}), folder_ / "said.txt");
  ASSERT_TRUE(until(player, [&] { return pad->hasEffects(); })) << said();
  pad.reset();
  clock_.sleepUntil(clock_.now() + 500ms);
  pad = std::make_unique<UinputPad>(test::xboxPad());
  ASSERT_TRUE(until(player, [&] { return pad->hasEffects(); })) << said();
  pad->turn(ABS_RZ, 255);
  EXPECT_TRUE(until(player, [&] { return pad->plays(); })) << said();
  player.send(SIGTERM);
  EXPECT_EQ(player.wait(), 0) << said();
  std::ifstream file(folder_ / "r.json");
  EXPECT_THAT(nlohmann::json::parse(file)["faults"].dump(), testing::HasSubstr("haptic device back"));
}

TEST_F(PlayerOnAGamepad, TheListOfDevicesHasIt) {
  const UinputPad pad(test::xboxPad());
  const auto listed = test::runProgram("relievo devices", folder_ / "");
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_THAT(listed.out, testing::ContainsRegex("gamepad:" + pad.node() + " +there +pad: rumble"));
}

}  // namespace
}  // namespace relievo
