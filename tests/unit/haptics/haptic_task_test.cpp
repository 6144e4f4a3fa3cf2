// SPDX-License-Identifier: Apache-2.0
// The haptic task in simulated time on a minimal device: mapping, limits, loss, a feed that stops.
#include "app/haptics/task/haptic_task.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "app/haptics/baseline/methods.h"
#include "platform/cyclic_thread.h"
#include "tests/support/device/fake_haptic_device.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
constexpr DisplayVolume kVolume{160, 108, 40};
constexpr double kStiffness = 0.5;

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
    SurfaceWindow& w = task_->windowToFill();
    w = test::makeWindow(frames, kVolume);
    w.clock = {.media = {}, .monotonic = clock_.now(), .rate = rate};
    w.ended = ended;
    task_->publishWindow();
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

// As when a mouse is lifted: the device moves without touching anything.
TEST_F(HapticTaskTest, TheClutchTakesTheForceAway) {
  publishPlane(20, 0, true);
  press(2);
  tick(50);
  ASSERT_NEAR(device_.force.z, 1.0, 0.05);
  device_.buttons |= 2U;
  tick(100);  // 50 N/s
  EXPECT_NEAR(glm::length(device_.force), 0, 1e-9);
}

TEST_F(HapticTaskTest, AllThatItHoldsIsUnderAMebibyte) {
  const std::size_t rings_and_windows = sizeof(HapticTask);
  const std::size_t method = ::malloc_usable_size(method_.get());  // one object
  const std::size_t stack = CyclicConfig{}.stack_bytes;
  RecordProperty("bytes", static_cast<int>(rings_and_windows + method + stack));
  EXPECT_LT(rings_and_windows + method + stack, 1U << 20U) << rings_and_windows << " " << method << " " << stack;
}

TEST_F(HapticTaskTest, PutsTheMiddleOfTheWorkspaceInTheMiddleOfTheVolume) {
  device_.position = {1, 2, 3};
  tick();
  ASSERT_TRUE(task_->refreshFinger());
  EXPECT_EQ(task_->finger().hip_mm, glm::dvec3(1, 2, 23));
  EXPECT_EQ(task_->finger().buttons, 5u);
  EXPECT_FALSE(task_->finger().contact);
  EXPECT_EQ(device_.writes, 1);
}

TEST_F(HapticTaskTest, PushesAFingerOutWithStiffnessTimesDepthWithinTheDevicesPeak) {
  publishPlane(20, 0);
  press(3);
  tick(100);
  EXPECT_NEAR(device_.force.z, 0.5 * 3, 0.01);
  for (double z = -3; z > -15; z -= 0.25) {
    device_.position.z = z;
    tick();
  }
  tick(200);
  EXPECT_NEAR(device_.force.z, 4.0, 1e-6) << "7.4 N are asked for, the device has 4";
  EXPECT_NEAR(task_->counters().max_force_n.load(), 4.0, 1e-6);
  EXPECT_LE(task_->counters().max_scene_slew_n_per_s.load(), 50.0 + 1e-6);
}

TEST_F(HapticTaskTest, ALostDeviceEndsTheForceAndIsToldOnce) {
  publishPlane(20, 0);
  press(1);
  tick(50);
  EXPECT_GT(device_.force.z, 0.4);
  device_.next_error = ErrorCode::Lost;
  const int writes = device_.writes;
  tick(20);
  EXPECT_EQ(device_.writes, writes) << "nothing is written to a lost device";
  EXPECT_EQ(device_.state(), HapticDevice::State::Lost);
  EXPECT_EQ(faults(), std::vector{HapticFault::Kind::DeviceLost});
  ASSERT_TRUE(task_->refreshFinger());
  EXPECT_FALSE(task_->finger().device_present);
  EXPECT_EQ(task_->finger().force_n, glm::dvec3(0));
}

TEST_F(HapticTaskTest, OneFailedExchangeLeavesOutOneTick) {
  tick(3);
  device_.next_error = ErrorCode::Io;
  tick(1);
  EXPECT_EQ(device_.writes, 3);
  tick(2);
  EXPECT_EQ(device_.writes, 5);
  EXPECT_EQ(faults(), std::vector{HapticFault::Kind::DeviceError});
}

TEST_F(HapticTaskTest, AFeedThatStopsFadesTheForceAndOneThatComesBackBringsItBack) {
  publishPlane(20);
  press(1);
  tick(50);
  const double held = device_.force.z;
  EXPECT_NEAR(held, 0.5, 0.01);
  EXPECT_TRUE(faults().empty());
  tick(50);  // 109 ms; the last frame began at 40 ms, stale from 40 + 60
  EXPECT_EQ(faults(), std::vector{HapticFault::Kind::FeedStale});
  EXPECT_LT(device_.force.z, held);
  tick(20);
  EXPECT_EQ(device_.force.z, 0);
  publishPlane(20);
  tick(30);
  EXPECT_EQ(faults(), std::vector{HapticFault::Kind::FeedRecovered});
  EXPECT_NEAR(device_.force.z, held, 0.01);
}

TEST_F(HapticTaskTest, APausedOrEndedFilmStaysTouchable) {
  for (const bool ended : {false, true}) {
    publishPlane(20, ended ? 1 : 0, ended);
    press(1);
    tick(1000);
    EXPECT_NEAR(device_.force.z, 0.5, 0.01);
  }
  EXPECT_TRUE(faults().empty());
}

TEST_F(HapticTaskTest, HandsEveryTickToTheRecorderInOrder) {
  tick(100);
  for (int i = 0; i < 100; ++i) {
    const auto state = task_->nextTick();
    ASSERT_TRUE(state.has_value());
    EXPECT_EQ(state->time, MonotonicTime{} + 5s + (i + 1) * 1ms);
  }
  EXPECT_FALSE(task_->nextTick().has_value());
  EXPECT_EQ(task_->counters().ticks.load(), 100u);
}

// Records how often the device had been read and written when each function of the method was called.
class Witness final : public TouchMethod {
 public:
  explicit Witness(const test::FakeHapticDevice& device) : device_(device) {}
  void prefetch(const SurfaceWindow&) const RELIEVO_RT override { prefetch_ = now(); }
  Touch update(const glm::dvec3& hip_mm, const SurfaceWindow&, MediaTime) RELIEVO_RT override {
    update_ = now();
    return {.proxy_mm = hip_mm};
  }
  void upkeep(const SurfaceWindow&, MediaTime) RELIEVO_RT override { upkeep_ = now(); }
  void reset() RELIEVO_RT override {}

  using Exchanges = std::pair<int, int>;
  mutable Exchanges prefetch_{-1, -1};
  Exchanges update_{-1, -1}, upkeep_{-1, -1};

 private:
  [[nodiscard]] Exchanges now() const RELIEVO_RT { return {device_.reads, device_.writes}; }
  const test::FakeHapticDevice& device_;
};

TEST_F(HapticTaskTest, FetchesBeforeTheDeviceIsAskedAndKeepsUpWhenTheForceIsOut) {
  Witness witness(device_);
  task_ = std::make_unique<HapticTask>(device_, witness, clock_, kVolume, SafetyLimits{}, kStiffness);
  tick();
  EXPECT_EQ(witness.prefetch_, Witness::Exchanges(0, 0));
  EXPECT_EQ(witness.update_, Witness::Exchanges(1, 0));
  EXPECT_EQ(witness.upkeep_, Witness::Exchanges(1, 1));
}

}  // namespace
}  // namespace relievo
