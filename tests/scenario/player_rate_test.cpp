// SPDX-License-Identifier: Apache-2.0
// A film that is felt at other rates than 1 kHz: as many ticks, none of them lost on the way to the recording, and no
// stiffer than the device is stable.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "app/player/touch/recorder.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

// A still plane at 20 mm, and a finger that comes from above and stays 3 mm deep in it.
class PlayerRate : public testing::Test {
 protected:
  PlayReport feel(double rate_hz) {
    PlayerBench bench;
    MockTrack plane = PlayerBench::depthTrack(100);
    plane.sample = [](int, int, int, int) { return std::uint16_t{128}; };
    bench.sources["film"] = {.tracks = {PlayerBench::colorTrack(100), plane}};
    bench.config.duration = 3s;
    bench.make_haptic = [rate_hz](Clock& clock) {
      MockHapticProfile profile;
      profile.capabilities.max_stiffness_n_per_mm = 0.4;
      profile.position_mm = [](double t_s) { return glm::dvec3(0, 0, std::max(17.0, 24 - 20 * t_s)); };
      auto device = makeMockHaptic(profile, clock);
      EXPECT_EQ(device->setRate(rate_hz).value(), rate_hz);
      return device;
    };
    auto recorder = Recorder::create(folder_ / "ticks.csv");
    EXPECT_TRUE(recorder);
    bench.recorder = &*recorder;
    EXPECT_TRUE(bench.run());
    EXPECT_TRUE(recorder->file().commit());
    return bench.report;
  }
  // The number of recorded ticks, and the longest step between their times.
  [[nodiscard]] std::pair<std::size_t, double> countAndLongestStep() const {
    std::ifstream file(folder_ / "ticks.csv");
    std::string line;
    std::getline(file, line);
    std::size_t count = 0;
    double before = 0, longest = 0;
    for (; std::getline(file, line); ++count) {
      const double now = std::stod(line);
      if (count > 0) longest = std::max(longest, now - before);
      before = now;
    }
    return {count, longest};
  }
  test::TemporaryFolder folder_;
};

TEST_F(PlayerRate, IsThatOfTheTicksAndNoneIsMissingFromTheRecording) {
  for (const double hz : {500.0, 1000.0, 2000.0, 4000.0, 8000.0}) {
    const HapticSummary haptic = feel(hz).haptic;
    EXPECT_NEAR(haptic.rate_hz, hz, 1e-6);
    EXPECT_NEAR(static_cast<double>(haptic.ticks), 3 * hz, 0.1 * hz) << "3 s, less what opening took";
    const auto [count, longest_s] = countAndLongestStep();
    EXPECT_EQ(count, haptic.ticks);
    EXPECT_NEAR(longest_s, 1 / hz, 1e-9);
    EXPECT_LE(haptic.max_scene_slew_n_per_s, 50 + 1e-6);
  }
}

// 0.4 N/mm are stable at 1 kHz: 0.2 at 500 Hz. At 4 kHz it would be 0.53, of which the player asks for 0.5.
TEST_F(PlayerRate, BoundsTheStiffnessThatIsRendered) {
  const double depth_mm = 40.0 * 128 / 255 - 17;
  for (const auto& [hz, stiffness] : {std::pair{500.0, 0.2}, {1000.0, 0.4}, {4000.0, 0.5}}) {
    const PlayReport report = feel(hz);
    EXPECT_NEAR(report.haptic.max_force_n, stiffness * depth_mm, 0.03) << hz;
  }
}

}  // namespace
}  // namespace relievo
