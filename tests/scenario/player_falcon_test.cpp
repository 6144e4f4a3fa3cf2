// SPDX-License-Identifier: Apache-2.0
// The whole player, as a program, on a Falcon that is plugged into this machine: the grip presses into a slope, and
// what the haptic task computed arrives at the motors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "app/haptics/task/workspace_mapping.h"
#include "drivers/falcon/falcon.h"
#include "drivers/falcon/link.h"
#include "tests/support/device/falcon_model.h"
#include "tests/support/device/usb/plugged_usb.h"
#include "tests/support/film/slope.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"
#include "tests/support/machine/sanitizers.h"

namespace relievo {
namespace {

struct Tick {
  glm::dvec3 hip_mm{0}, force_n{0};
};

std::vector<Tick> readTicks(const std::string& path) {
  std::vector<Tick> ticks;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream row(line);
    std::vector<double> n;
    for (std::string cell; n.size() < 10 && std::getline(row, cell, ',');) n.push_back(std::stod(cell));
    ticks.push_back({{n[1], n[2], n[3]}, {n[7], n[8], n[9]}});
  }
  return ticks;
}

WorkspaceMapping filmMapping() {
  MonotonicClock clock;
  return {makeFalcon({}, clock)->capabilities(), DisplayVolume::forPicture(test::kSlopeCols, test::kSlopeRows)};
}

falcon::Words wordsOf(const Tick& tick, const WorkspaceMapping& mapping) {
  const auto pose = falcon::inverse(mapping.deviceAt(tick.hip_mm));
  if (!pose) return {};
  return falcon::Motors(falcon::kDefaultCountsPerNm).wordsFor(falcon::torquesOf(tick.force_n, *pose), 0.001);
}

// The factor from 0 to 1 by which `part` is `whole`, within one count of each motor word; nullopt if there is none.
std::optional<double> shareOf(const falcon::Words& part, const falcon::Words& whole) {
  const glm::dvec3 p{part[0], part[1], part[2]}, w{whole[0], whole[1], whole[2]};
  if (whole == falcon::Words{}) return {};
  const double share = std::clamp(glm::dot(p, w) / glm::dot(w, w), 0.0, 1.0);
  const glm::dvec3 off = glm::abs(p - share * w);
  return std::max({off.x, off.y, off.z}) <= 1 ? std::optional(share) : std::nullopt;
}

// The most of `sent` that follow ticks in order, each a share of the tick's command that `allowed` takes: the longest
// common subsequence by Hunt and Szymanski (1977). last[n] is the earliest tick that the (n+1)th of them can follow.
template <typename Allowed>
std::size_t inOrder(const std::vector<falcon::Words>& sent, const std::vector<Tick>& ticks, Allowed allowed) {
  const WorkspaceMapping mapping = filmMapping();
  std::vector<falcon::Words> computed;
  for (const Tick& tick : ticks) computed.push_back(wordsOf(tick, mapping));
  std::vector<std::size_t> last;
  for (const falcon::Words& words : sent) {
    for (std::size_t tick = ticks.size(); tick-- > 0;) {
      const std::optional<double> share = shareOf(words, computed[tick]);
      if (!share || !allowed(ticks[tick], *share)) continue;
      const auto place = std::ranges::lower_bound(last, tick);
      if (place == last.end()) {
        last.push_back(tick);
      } else {
        *place = tick;
      }
    }
  }
  return last.size();
}

TEST(PlayerOnAFalcon, WhatTheTaskComputesArrivesAtTheMotors) {
  const test::TemporaryFolder folder;

  test::FalconModel model({});
  model.runFirmware();
  test::circle(model);
  const auto usb = test::plugIn(model, falcon::kUsbId);
  if (usb == nullptr) GTEST_SKIP() << test::kNoPlug;
  test::makeSlope(folder / "slope.mkv");
  const auto played = test::runProgram("relievo play " + (folder / "slope.mkv") +
                                           " --display mock --haptic falcon --duration 7 --report " +
                                           (folder / "r.json") + " --record " + (folder / "t.csv"),
                                       folder / "");
  ASSERT_EQ(played.exit_code, 0) << played.err;
  std::ifstream file(folder / "r.json");
  const auto report = nlohmann::json::parse(file);
  EXPECT_EQ(report["haptic"]["device"], "Novint Falcon");
  EXPECT_GT(report["force"]["max_n"].get<double>(), 0.5);
  EXPECT_EQ(usb->unknownRequests(), 0);

  const std::lock_guard guard(usb->lock());
  EXPECT_EQ(model.last().motors, falcon::Words{}) << "zero in the end";
  const auto ticks = readTicks(folder / "t.csv");
  ASSERT_GT(ticks.size(), 100U) << "of 7000, on a machine that keeps up";
  // Each command other than zero must be that of a tick, in order. Two kinds of ticks have no command: those whose
  // command came while the one before was still being sent, and those of a machine that stopped for so long that the
  // driver set the force to zero. The force then fades in anew, as a share of the tick's force. That share is rounded
  // twice, so that it is sometimes more than one count off.
  std::vector<falcon::Words> sent;
  std::ranges::copy_if(model.history(), std::back_inserter(sent),
                       [](const falcon::Words& words) { return words != falcon::Words{}; });
  const std::size_t strays = sent.size() - inOrder(sent, ticks, [](const Tick&, double) { return true; });
  EXPECT_LE(strays, sent.size() / 100) << "of " << sent.size() << " commands";
  const std::size_t whole = inOrder(
      sent, ticks, [](const Tick& tick, double share) { return share > 0.99 && glm::length(tick.force_n) > 0.3; });
  if (ticks.size() <= 5000) GTEST_SKIP() << "a machine that leaves out ticks again and again never ends the fade";
  EXPECT_GT(whole, 10U) << "of some thousands";
}

TEST(CalibrateOnAFalcon, IsCalledOffWhileItWaitsForTheUser) {
  const test::TemporaryFolder folder;
  test::FalconModel model({});
  model.runFirmware();
  model.grip = [](double) { return test::FalconModel::kRestMm; };  // nobody moves it
  const auto usb = test::plugIn(model, falcon::kUsbId);
  if (usb == nullptr) GTEST_SKIP() << test::kNoPlug;
  MonotonicClock clock;
  const auto waits = [&] {
    const std::lock_guard guard(usb->lock());
    return model.last().homing;
  };
  test::Process calibrate({RELIEVO_BIN_DIR "/relievo", "devices", "calibrate"}, folder / "said.txt");
  while (!waits() && calibrate.isRunning()) clock.sleepUntil(clock.now() + std::chrono::milliseconds(1));
  calibrate.send(SIGINT);
  EXPECT_EQ(calibrate.wait(), 1);
  std::ifstream said(folder / "said.txt");
  const std::string text(std::istreambuf_iterator<char>(said), {});
  EXPECT_NE(text.find("pull its grip out"), std::string::npos) << text;
  EXPECT_NE(text.find("was cancelled"), std::string::npos) << text;
}

// While the Falcon pushes, the player gets each signal that can end a process.
TEST(PlayerOnAFalcon, NoSignalThatEndsItLeavesAForce) {
  if (test::machineIsMocked()) GTEST_SKIP() << "umockdev does not stand a program that dies in the middle of a request";
  const test::TemporaryFolder folder;
  test::makeSlope(folder / "slope.mkv");
  for (const int number : {SIGTERM, SIGSEGV, SIGQUIT, SIGUSR1}) {
    if (number == SIGSEGV && kMemorySanitizer) continue;  // it has a handler of its own
    SCOPED_TRACE(::strsignal(number));
    test::FalconModel model({});
    model.runFirmware();
    test::circle(model);
    const auto usb = test::plugIn(model, falcon::kUsbId);
    if (usb == nullptr) GTEST_SKIP() << test::kNoPlug;
    MonotonicClock clock;
    const auto pushes = [&] {
      const std::lock_guard guard(usb->lock());
      return model.pushes(clock.now());
    };
    test::Process player(
        {RELIEVO_BIN_DIR "/relievo", "play", folder / "slope.mkv", "--display", "mock", "--haptic", "falcon", "--loop"},
        folder / "said.txt");
    while (!pushes() && player.isRunning()) clock.sleepUntil(clock.now() + std::chrono::milliseconds(1));
    EXPECT_TRUE(player.isRunning());
    player.send(number);
    EXPECT_EQ(player.wait(), number == SIGSEGV ? -number : 0);
    EXPECT_FALSE(pushes());
  }
}

}  // namespace
}  // namespace relievo
