// SPDX-License-Identifier: Apache-2.0
// A session is recorded, played again from the recording and recorded again: the two are the same to the last byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <sstream>
#include <utility>

#include "app/player/touch/recorder.h"
#include "drivers/replay/replay.h"
#include "drivers/sim/profiles.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

class ReplayPath : public testing::Test {
 protected:
  // Plays six seconds of the film on that device and returns the recording.
  std::string record(const std::string& name, std::function<std::unique_ptr<HapticDevice>(Clock&)> make_haptic,
                     std::optional<DisplayVolume> volume = {}) {
    PlayerBench bench;
    bench.config.volume = volume;
    bench.sources["film"] = PlayerBench::film(120);
    bench.config.duration = 4s;
    bench.make_haptic = std::move(make_haptic);
    auto recorder = Recorder::create(folder_ / name);
    EXPECT_TRUE(recorder);
    bench.recorder = &*recorder;
    EXPECT_TRUE(bench.run());
    EXPECT_EQ(bench.report.faults.size(), 0u);
    EXPECT_GT(bench.report.haptic.max_force_n, 0.5);
    EXPECT_TRUE(recorder->file().commit());
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }
  test::TemporaryFolder folder_;
};
class ReplaySession : public ReplayPath, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Devices, ReplaySession, testing::Values("phantom", "falcon,tapping", "polhem,shaking"));

TEST_P(ReplaySession, IsTheRecordedOneToTheLastByte) {
  const std::string first = record("first.csv", [](Clock& clock) {
    SimSetup setup = parseSim(GetParam()).value();
    setup.profile.encoder_step_mm = 0;  // positions with all their digits
    return makeSimHaptic(setup.profile, setup.path, clock);
  });
  ASSERT_GT(std::ranges::count(first, '\n'), 3500);
  const std::string again =
      record("again.csv", [this](Clock&) { return makeReplay(Recording::load(folder_ / "first.csv").value()); });
  EXPECT_EQ(again.size(), first.size());
  EXPECT_TRUE(again == first);
}

// In a box of any depth the finger is where the path is; 25 places a second are gone through in their time.
TEST_F(ReplayPath, IsInTheSceneAtItsTime) {
  const auto replay = [this](const char* name) {
    return [name, this](Clock&) { return makeReplay(Recording::load(folder_ / name).value()); };
  };
  for (const auto& [depth_mm, after_a_second] : {std::pair(20.0, "\n1,3,-4,11.75,"), std::pair(80.0, "\n1,3,-4,47,")}) {
    std::ofstream path(folder_ / "path.csv");
    path << "t_s,x_mm,y_mm,z_mm\n";
    for (int i = 0; i <= 100; ++i) {
      path << 0.04 * i << ",3,-4," << std::max(0.25 * depth_mm, (0.9 - 0.0125 * i) * depth_mm) << "\n";
    }
    path.close();
    const DisplayVolume box{160, 120, depth_mm};
    const std::string first = record("first.csv", replay("path.csv"), box);
    EXPECT_NE(first.find(after_a_second), std::string::npos) << depth_mm;
    EXPECT_TRUE(record("again.csv", replay("first.csv"), box) == first);
  }
}

// The finger's force at its time in microseconds.
using Forces = std::map<long, glm::dvec3>;
Forces forcesIn(const std::string& csv) {
  Forces forces;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::vector<double> row;
    std::istringstream cells(line);
    for (std::string cell; row.size() < 10 && std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    forces[std::lround(1e6 * row[0])] = {row[7], row[8], row[9]};  // after the time, finger and proxy
  }
  return forces;
}

// Between two recorded places the finger goes straight. Forces differ by what is held and limited within a tick: by
// 0.02 N in the mean square, and in one tick of a hundred by more than 0.1 N.
TEST_P(ReplaySession, AtAnotherRateIsTheSameForceAtTheSameTime) {
  const std::string first = record("first.csv", [](Clock& clock) {
    const SimSetup setup = parseSim(GetParam()).value();
    return makeSimHaptic(setup.profile, setup.path, clock);
  });
  const Forces recorded = forcesIn(first);
  for (const double hz : {500.0, 2000.0, 4000.0, 8000.0}) {
    const Forces again = forcesIn(record("again.csv", [this, hz](Clock&) {
      auto device = makeReplay(Recording::load(folder_ / "first.csv").value());
      EXPECT_EQ(device->setRate(hz).value(), hz);
      return device;
    }));
    EXPECT_NEAR(static_cast<double>(again.size()), static_cast<double>(recorded.size()) * hz / 1000, hz / 100);
    double squares = 0;
    int both = 0, apart = 0;
    for (const auto& [time, force] : recorded) {
      const auto found = again.find(time);
      if (found == again.end()) continue;
      ++both;
      const double off = glm::distance(found->second, force);
      squares += off * off;
      apart += off > 0.1 ? 1 : 0;
    }
    ASSERT_GT(both, 1700);
    RecordProperty("rms_n_at_" + std::to_string(static_cast<int>(hz)), std::to_string(std::sqrt(squares / both)));
    EXPECT_LT(std::sqrt(squares / both), 0.02) << hz;
    EXPECT_LT(apart, both / 100) << hz;
  }
}

}  // namespace
}  // namespace relievo
