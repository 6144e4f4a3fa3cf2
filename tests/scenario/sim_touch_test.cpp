// SPDX-License-Identifier: Apache-2.0
// Every simulated device in every simulated hand under the haptic task, with the default method on a flat surface and
// the stiffness that the device says it holds, in simulated time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "app/haptics/baseline/methods.h"
#include "app/haptics/task/haptic_task.h"
#include "drivers/sim/profiles.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 90, 40};
constexpr double kHeightMm = 20, kSeconds = 6;

struct Felt {
  std::vector<double> z_mm;  // of the device, one a millisecond
  int contacts = 0;
  double artefact_mj = 0;
};

Felt touchPlane(const DeviceProfile& profile, double stiffness, HandMotion motion) {
  ManualClock clock;
  const auto device = makeSimHaptic(profile, HandPath(motion, 0.7), clock);
  EXPECT_TRUE(device->open() && device->home() && device->start());
  const double in_scene = stiffness / WorkspaceMapping(device->capabilities(), kVolume).scale();
  const auto method = makeMethod(kDefaultMethod, {.stiffness_n_per_mm = in_scene});
  const auto task = std::make_unique<HapticTask>(*device, *method, clock, kVolume, SafetyLimits{}, in_scene);

  std::vector<Frame> frames;
  for (const double t : {0.0, 0.04, 0.08, 0.12}) {
    frames.push_back(test::makeReliefFrame(80, 45, kVolume, mediaTime(t), [](double, double) { return kHeightMm; }));
  }
  task->windowToFill() = test::makeWindow(frames, kVolume);
  task->windowToFill().clock = {.media = {}, .monotonic = clock.now(), .rate = 0};  // paused
  task->publishWindow();

  Felt felt;
  const double offset = 0.5 * (profile.workspace_min_mm + profile.workspace_max_mm).z;
  const double scale = WorkspaceMapping(device->capabilities(), kVolume).scale();
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(kSeconds * profile.rate_hz); ++i) {
    clock.advance(fromSeconds(1 / profile.rate_hz));
    static_cast<void>(task->loop({i, clock.now(), clock.now()}));
    const auto tick = task->nextTick();
    EXPECT_TRUE(tick && tick->device_present);
    if (i % static_cast<std::uint64_t>(profile.rate_hz / 1000) != 0) continue;
    felt.z_mm.push_back((tick->hip_mm.z - 0.5 * kVolume.depth_mm) / scale + offset);
    felt.contacts += tick->contact ? 1 : 0;
  }
  felt.artefact_mj = task->counters().artefact_energy_mj;
  return felt;
}

struct Held {
  SimDeviceName device;
  SimHandName hand;
};
void PrintTo(const Held& held, std::ostream* out) {
  *out << held.device.word << " in a hand that is " << held.hand.word;
}
std::vector<Held> all() {
  std::vector<Held> pairs;
  for (const auto& device : simDevices()) {
    for (const auto& hand : simHands()) pairs.push_back({device, hand});
  }
  return pairs;
}

class SimTouch : public testing::TestWithParam<Held> {};
INSTANTIATE_TEST_SUITE_P(All, SimTouch, testing::ValuesIn(all()));

// The device moves as it would without delay, jitter and encoder at eight times the rate, and a hand that is still
// stays still.
TEST_P(SimTouch, HoldsWhatTheDevicePromises) {
  const HandMotion motion = GetParam().hand.motion;
  for (const double jitter_ticks : {0.0, 1.0}) {
    SCOPED_TRACE(testing::Message() << "jitter " << jitter_ticks);
    DeviceProfile real = GetParam().device.profile;
    real.hand = GetParam().hand.hand;
    real.jitter_ticks = jitter_ticks;
    ManualClock clock;
    const double stiffness = makeSimHaptic(real, HandPath(), clock)->capabilities().max_stiffness_n_per_mm;
    DeviceProfile ideal = real;
    ideal.encoder_step_mm = 0, ideal.delay_ticks = 0, ideal.jitter_ticks = 0, ideal.rate_hz = 8000;

    const Felt felt = touchPlane(real, stiffness, motion), wished = touchPlane(ideal, stiffness, motion);
    double off = 0;
    for (std::size_t i = 0; i < felt.z_mm.size(); ++i) off = std::max(off, std::abs(felt.z_mm[i] - wished.z_mm[i]));
    EXPECT_LT(off, motion == HandMotion::Tapping ? 0.8 : 0.2);
    EXPECT_GT(felt.contacts, 2000);
    EXPECT_LT(felt.artefact_mj, 0.1);
    const auto [low, high] = std::minmax_element(felt.z_mm.end() - 1500, felt.z_mm.end());
    const bool still = motion == HandMotion::Resting || motion == HandMotion::Pressing;
    EXPECT_TRUE(!still || *high - *low <= real.encoder_step_mm) << *high - *low;
  }
}

}  // namespace
}  // namespace relievo
