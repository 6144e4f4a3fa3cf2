// SPDX-License-Identifier: Apache-2.0
// A HapticTask on a fake device in simulated time.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <memory>
#include <vector>

#include "app/haptics/baseline/methods.h"
#include "app/haptics/task/haptic_task.h"
#include "platform/cyclic_thread.h"
#include "tests/support/device/fake_haptic_device.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {

using namespace std::chrono_literals;

inline constexpr DisplayVolume kVolume{160, 108, 40};
inline constexpr double kStiffness = 0.5;

class HapticTaskTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(device_.open() && device_.home() && device_.start());
    task_ = std::make_unique<HapticTask>(device_, *method_, clock_, kVolume, SafetyLimits{}, kStiffness);
  }
  // A still plane at `height`, playing from time 0, with frames at 0 and 40 ms.
  void publishPlane(double height, double rate = 1, bool ended = false) {
    std::vector<Frame> frames;
    for (const double t : {0.0, 0.04}) {
      frames.push_back(test::makeReliefFrame(40, 30, kVolume, mediaTime(t), [&](double, double) { return height; }));
    }
    publish(frames, {.media = {}, .monotonic = clock_.now(), .rate = rate}, ended);
  }
  void publish(const std::vector<Frame>& frames, const ClockSample& clock, bool ended = false,
               Duration carried = Duration(0)) {
    SurfaceWindow& w = task_->windowToFill();
    w = test::makeWindow(frames, kVolume);
    w.clock = clock;
    w.ended = ended;
    w.carried = carried;
    task_->publishWindow();
  }
  // How many ticks pass until the feed counts as late, when the film begins now and has these frames.
  int ticksUntilLate(std::initializer_list<double> times_s, Duration carried = Duration(0)) {
    std::vector<Frame> frames;
    for (const double t : times_s) {
      frames.push_back(test::makeReliefFrame(40, 30, kVolume, mediaTime(t), [](double, double) { return 20.0; }));
    }
    publish(frames, {.media = {}, .monotonic = clock_.now(), .rate = 1}, false, carried);
    for (int ticks = 1; ticks < 2000; ++ticks) {
      tick();
      const auto told = faults();
      if (told == std::vector{HapticFault::Kind::FeedStale}) return ticks;
    }
    return 0;
  }
  void tick(int n = 1) {
    for (int i = 0; i < n; ++i) {
      clock_.advance(1ms);
      ASSERT_EQ(task_->loop({index_++, clock_.now(), clock_.now()}), LoopControl::Continue);
    }
  }
  // From 1 mm outside a plane at 20 mm to `depth` inside, slowly enough not to count as a jump.
  void press(double depth) {
    for (double z = 1; z > -depth; z -= 0.25) {
      device_.position = {0, 0, z};
      tick();
    }
    device_.position = {0, 0, -depth};
    tick();
  }
  std::vector<HapticFault::Kind> faults() {
    std::vector<HapticFault::Kind> kinds;
    while (const auto fault = task_->nextFault()) kinds.push_back(fault->kind);
    return kinds;
  }

  ManualClock clock_{MonotonicTime{} + 5s};
  test::FakeHapticDevice device_;
  std::unique_ptr<TouchMethod> method_ = makeMethod("modified-proxy-graph", {.stiffness_n_per_mm = kStiffness});
  std::unique_ptr<HapticTask> task_;
  std::uint64_t index_ = 0;
};

}  // namespace relievo::test
