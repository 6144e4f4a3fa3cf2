// SPDX-License-Identifier: Apache-2.0
// Two devices on one film: each feels to the last bit what it feels alone, also when the other goes away.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/player/touch/recorder.h"
#include "drivers/sim/profiles.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

using MakeDevice = std::function<std::unique_ptr<HapticDevice>(Clock&)>;

// A simulated device in a simulated hand, at a rate of its own.
MakeDevice simulated(const char* words, double rate_hz) {
  return [=](Clock& clock) {
    SimSetup setup = parseSim(words).value();
    auto device = makeSimHaptic(setup.profile, setup.path, clock);
    EXPECT_TRUE(device->setRate(rate_hz));
    return device;
  };
}

class TwoFingers : public testing::Test {
 protected:
  struct Traces {
    std::string first, second;
    PlayReport report;
  };
  // Six seconds with a pause, a seek, slow motion and a film that ends and begins again.
  Traces play(const MakeDevice& first, const MakeDevice& second) {
    PlayerBench bench;
    bench.sources["film"] = PlayerBench::film(100);
    bench.config.duration = 6s;
    bench.config.loop = true;
    bench.press(1.0, KEY_PLAYPAUSE);
    bench.press(1.4, KEY_PLAYPAUSE);
    bench.press(2.0, KEY_RIGHT);
    bench.press(2.6, KEY_SLOW);
    bench.press(3.2, KEY_PLAYPAUSE);
    bench.make_haptic = first;
    bench.make_second = second;
    const MonotonicTime begun = bench.clock.now();
    force_there_n_ = force_away_n_ = 0;
    bench.display.shown = [&] {
      const double now_s = toSeconds(bench.clock.now() - begun);
      double& most_n = hand_->unplugged ? force_away_n_ : force_there_n_;
      most_n = std::max(most_n, hand_->force().z);
      hand_->unplugged = now_s > 1.8 && now_s < 2.8;
    };
    auto recorder = Recorder::create(folder_ / "first.csv");
    auto second_recorder = Recorder::create(folder_ / "second.csv");
    EXPECT_TRUE(recorder && second_recorder);
    bench.recorder = &*recorder;
    bench.second_recorder = &*second_recorder;
    EXPECT_TRUE(bench.run());
    EXPECT_TRUE(recorder->file().commit() && second_recorder->file().commit());
    return {textOf("first.csv"), textOf("second.csv"), bench.report};
  }
  [[nodiscard]] std::string textOf(const char* name) const { return test::contentOf(folder_ / name); }
  static std::uint64_t faults(const PlayReport& report, const std::string& what) {
    std::uint64_t count = 0;
    for (const FaultEntry& fault : report.faults) count += fault.what == what ? fault.count : 0;
    return count;
  }
  test::TemporaryFolder folder_;
  // Of a mock: unplugged for a second, with the most force in its motors then and at other times.
  std::shared_ptr<MockHapticBench> hand_ = std::make_shared<MockHapticBench>();
  double force_there_n_ = 0, force_away_n_ = 0;
};

void expectSame(const std::string& trace, const std::string& alone) {
  ASSERT_GT(std::ranges::count(alone, '\n'), 2000);
  EXPECT_EQ(trace.size(), alone.size());
  EXPECT_TRUE(trace == alone);
}

TEST_F(TwoFingers, EachFeelsWhatItFeelsAloneToTheLastBit) {
  const MakeDevice first = simulated("falcon,tapping", 1000), second = simulated("phantom,shaking", 2000);
  const Traces both = play(first, second);
  expectSame(both.first, play(first, {}).first);
  expectSame(both.second, play(second, {}).first);
  EXPECT_GT(both.report.haptic.max_force_n, 0.5);
  ASSERT_TRUE(both.report.second_finger);
  EXPECT_GT(both.report.second_finger->haptic.max_force_n, 0.5);
  EXPECT_NE(both.report.haptic.device, both.report.second_finger->haptic.device);
  EXPECT_NEAR(both.report.second_finger->haptic.rate_hz, 2000, 1e-6);
  EXPECT_TRUE(both.report.faults.empty());
}

TEST_F(TwoFingers, TheReportTellsBoth) {
  const Traces both = play(simulated("phantom,tapping", 1000), simulated("falcon,shaking", 500));
  const auto json = nlohmann::json::parse(toJson(both.report));
  EXPECT_EQ(json["haptic"]["rate_hz"], 1000);
  EXPECT_EQ(json["second_finger"]["haptic"]["rate_hz"], 500);
  EXPECT_NEAR(json["second_finger"]["haptic"]["ticks"].get<double>(), 0.5 * json["haptic"]["ticks"].get<double>(), 2);
  EXPECT_GT(json["second_finger"]["force"]["max_n"], 0.5);
  EXPECT_TRUE(json["second_finger"]["energy"].contains("scene_mj"));
  const std::string text = toText(both.report);
  EXPECT_NE(text.find("touch   first finger (amber): " + both.report.haptic.device), std::string::npos) << text;
  EXPECT_NE(text.find("touch   second finger (blue): " + both.report.second_finger->haptic.device), std::string::npos)
      << text;
  EXPECT_FALSE(
      nlohmann::json::parse(toJson(play(simulated("phantom,tapping", 1000), {}).report)).contains("second_finger"));
}

// Either one is lost for a second: its motors are at zero until it is back.
TEST_F(TwoFingers, OneThatIsLostDoesNotDisturbTheOther) {
  const MakeDevice stays = simulated("phantom,stroking", 1000);
  const std::string alone = play(stays, {}).first;
  const MakeDevice leaves = [this](Clock& clock) {
    MockHapticProfile profile;
    profile.position_mm = [](double t_s) { return glm::dvec3(0, 0, t_s < 0.2 ? 25 : 12); };
    return makeMockHaptic(profile, clock, hand_);
  };
  for (const bool first_leaves : {false, true}) {
    const Traces both = first_leaves ? play(leaves, stays) : play(stays, leaves);
    expectSame(first_leaves ? both.second : both.first, alone);
    const std::string who = first_leaves ? "first finger (amber): " : "second finger (blue): ";
    EXPECT_EQ(faults(both.report, who + "haptic device lost"), 1U);
    EXPECT_EQ(faults(both.report, who + "haptic device back"), 1U);
    EXPECT_GT(force_there_n_, 0.5);
    EXPECT_EQ(force_away_n_, 0);
  }
}

}  // namespace
}  // namespace relievo
