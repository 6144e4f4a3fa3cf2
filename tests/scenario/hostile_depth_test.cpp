// SPDX-License-Identifier: Apache-2.0
// Depth that no camera makes, felt with every simulated device in every simulated hand, in simulated time.
#include <gtest/gtest.h>

#include <cstdint>

#include "app/haptics/task/safety.h"
#include "drivers/sim/profiles.h"
#include "tests/scenario/player_bench.h"

namespace relievo {
namespace {

struct Hostile {
  const char* name;
  std::uint16_t (*code)(int frame, int col, int row);
};
constexpr Hostile kClips[] = {
    {"near and far in turns", [](int f, int, int) -> std::uint16_t { return f % 2 == 0 ? 255 : 0; }},
    {"a leap by a quarter of the depth", [](int f, int, int) -> std::uint16_t { return f % 2 == 0 ? 160 : 96; }},
    {"columns in turns", [](int f, int c, int) -> std::uint16_t { return (f + c) % 2 == 0 ? 200 : 60; }},
    {"noise",
     [](int f, int c, int r) -> std::uint16_t {
       const auto mixed = static_cast<unsigned>(f) * 2654435761U ^ static_cast<unsigned>(c) * 40503U ^
                          static_cast<unsigned>(r) * 2246822519U;
       return static_cast<std::uint16_t>(mixed >> 7 & 255);
     }},
};
constexpr int kFrames = 250;  // 10 s

HapticSummary felt(const Hostile& clip, const SimDeviceName& device, const SimHandName& hand) {
  PlayerBench bench;
  MockMediaProfile film = PlayerBench::film(kFrames);
  film.tracks[1].sample = [&](int frame, int, int col, int row) { return clip.code(frame, col, row); };
  bench.sources["film"] = film;
  bench.make_haptic = [&](Clock& clock) {
    DeviceProfile profile = device.profile;
    profile.hand = hand.hand;
    return makeSimHaptic(profile, HandPath(hand.motion, 0.7), clock);
  };
  EXPECT_TRUE(bench.run().has_value());
  return bench.report.haptic;
}

// Without a tank the artefacts gave up to 770 mJ: a force that follows the scene at the slew limit still pushes when
// the surface has gone (SafetyFilter). The tank bounds that energy. The artefact's account doubles it where a surface
// leaves and returns the same way, because a force that rises late also resists the hand less.
TEST(HostileDepth, PumpsNoMoreThanTheTankGives) {
  const SafetyLimits limits;
  const double most = 2 * (2 * limits.tank_mj + limits.tank_mj_per_s * kFrames * toSeconds(PlayerBench::kPeriod));
  double largest = 0;
  for (const Hostile& clip : kClips) {
    for (const auto& device : simDevices()) {
      for (const auto& hand : simHands()) {
        const HapticSummary run = felt(clip, device, hand);
        SCOPED_TRACE(testing::Message() << clip.name << ", " << device.word << ", " << hand.word);
        EXPECT_LE(run.artefact_mj, most);
        EXPECT_LE(run.max_scene_slew_n_per_s, limits.scene_slew_n_per_s * (1 + 1e-9));
        EXPECT_LE(run.max_force_n, limits.force_n);
        EXPECT_GT(run.contact_ticks, run.ticks / 5);
        largest = std::max(largest, run.artefact_mj);
      }
    }
  }
  EXPECT_GT(largest, 0.5 * most) << "are the clips hostile?";
}

}  // namespace
}  // namespace relievo
