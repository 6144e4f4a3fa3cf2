// SPDX-License-Identifier: Apache-2.0
// A session is recorded, played again from the recording and recorded again: the two are the same to the last byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "app/player/touch/recorder.h"
#include "drivers/replay/replay.h"
#include "drivers/sim/profiles.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

class ReplaySession : public testing::TestWithParam<const char*> {
 protected:
  // Plays six seconds of the film on that device and tells what was recorded.
  std::string record(const std::string& name, std::function<std::unique_ptr<HapticDevice>(Clock&)> make_haptic) {
    PlayerBench bench;
    bench.sources["film"] = PlayerBench::film(120);
    bench.config.duration = 4s;
    bench.make_haptic = std::move(make_haptic);
    auto recorder = Recorder::create(folder_ / name);
    EXPECT_TRUE(recorder);
    bench.recorder = &*recorder;
    EXPECT_TRUE(bench.run());
    EXPECT_EQ(bench.report.faults.size(), 0u);
    EXPECT_GT(bench.report.haptic.max_force_n, 0.5);
    EXPECT_TRUE(recorder->finish());
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }
  test::TemporaryFolder folder_;
};
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

}  // namespace
}  // namespace relievo
