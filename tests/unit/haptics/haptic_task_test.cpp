// SPDX-License-Identifier: Apache-2.0
// The haptic task in simulated time on a minimal device: mapping, limits, loss, a feed that stops.
#include "app/haptics/task/haptic_task.h"

#include <gtest/gtest.h>

#include <malloc.h>
#include <algorithm>

#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "app/haptics/baseline/methods.h"
#include "platform/cyclic_thread.h"
#include "tests/support/device/fake_haptic_device.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/haptics/haptic_task_stage.h"

namespace relievo::test {
namespace {

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

// While clutched, and while the depth is late, the hand moves to the end of the device's range and is stopped softly
// there.
TEST_F(HapticTaskTest, TheEndsOfTheWorkspacePushAlsoWhereNothingIsFelt) {
  device_.position = {0, 0, -48};  // 2 mm into the last 4 of 50: 0.2 N/mm
  device_.buttons = 2U;
  tick(50);
  EXPECT_NEAR(device_.force.z, 0.4, 1e-9) << "clutched";
  device_.buttons = 0;
  publishPlane(20);
  tick(200);
  ASSERT_EQ(faults(), std::vector{HapticFault::Kind::FeedStale});
  EXPECT_NEAR(device_.force.z, 0.4, 1e-9) << "depth is late";
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

// One and a half periods after the newest frame, but not within 50 ms of it.
TEST_F(HapticTaskTest, AFeedIsLateWhenAFrameAndAHalfAreMissingAndNotSoonerThanIn50Milliseconds) {
  EXPECT_EQ(ticksUntilLate({0}), 51);
  publishPlane(20);
  tick();
  ASSERT_EQ(faults(), std::vector{HapticFault::Kind::FeedRecovered});
  EXPECT_EQ(ticksUntilLate({0, 0.01}), 10 + 51);
  publishPlane(20);
  tick();
  ASSERT_EQ(faults(), std::vector{HapticFault::Kind::FeedRecovered});
  EXPECT_EQ(ticksUntilLate({0, 0.2}), 200 + 301);
}

// Frames of a live film come as late as it is carried forward, without being missed.
TEST_F(HapticTaskTest, AFeedThatIsCarriedForwardIsLateByThatMuchLater) {
  EXPECT_EQ(ticksUntilLate({0, 0.01}, 30ms), 10 + 30 + 51);
}

// The film's clock has run past the newest frame and then stops: the surface is that of the newest frame.
TEST_F(HapticTaskTest, AFilmThatIsPausedWhileItsDepthIsLateIsTouchableAgain) {
  publishPlane(20);
  press(1);
  tick(200);
  ASSERT_EQ(faults(), std::vector{HapticFault::Kind::FeedStale});
  ASSERT_EQ(device_.force.z, 0);
  const std::vector frames{test::makeReliefFrame(40, 30, kVolume, {}, [](double, double) { return 20.0; })};
  publish(frames, {.media = mediaTime(0.2), .monotonic = clock_.now(), .rate = 0});
  tick(30);
  EXPECT_EQ(faults(), std::vector{HapticFault::Kind::FeedRecovered});
  EXPECT_NEAR(device_.force.z, 0.5, 0.01);
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

TEST_F(HapticTaskTest, ADeviceThatTellsBySignsRestsInAPause) {
  device_.rests_in_pause = true;
  task_ = std::make_unique<HapticTask>(device_, *method_, clock_, kVolume, SafetyLimits{}, kStiffness);
  publishPlane(20, 1, true);
  press(2);
  tick(50);
  ASSERT_NEAR(device_.force.z, 1.0, 0.05);
  publishPlane(20, 0, true);
  tick(30);  // 50 N/s
  EXPECT_EQ(device_.force, glm::dvec3(0));
  ASSERT_TRUE(task_->refreshFinger());
  EXPECT_TRUE(task_->finger().contact) << "the picture shows it all the same";
  publishPlane(20, 1, true);
  tick(30);
  EXPECT_NEAR(device_.force.z, 1.0, 0.05) << "the film goes on";
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

TEST_F(HapticTaskTest, ALossIsToldBehindMoreFaultsThanAreKept) {
  for (int i = 0; i < 70; ++i) {
    device_.next_write_error = ErrorCode::Io;
    tick();
  }
  device_.next_write_error = ErrorCode::Lost;
  tick(3);
  const auto told = faults();
  EXPECT_EQ(std::ranges::count(told, HapticFault::Kind::DeviceError), 64);
  EXPECT_EQ(std::ranges::count(told, HapticFault::Kind::DeviceLost), 1);
  EXPECT_EQ(faults().size(), 0u);
}

TEST_F(HapticTaskTest, AForceThatCouldNotBeWrittenIsTold) {
  tick(3);
  device_.next_write_error = ErrorCode::Io;
  tick(3);
  EXPECT_EQ(device_.writes, 5);
  EXPECT_EQ(faults(), std::vector{HapticFault::Kind::DeviceError});
  device_.next_write_error = ErrorCode::Lost;
  tick(3);
  EXPECT_EQ(device_.writes, 5) << "the ticks leave it alone";
  EXPECT_EQ(faults(), std::vector{HapticFault::Kind::DeviceLost});
}

// The time without the device is no time in which the force may rise.
TEST_F(HapticTaskTest, TheForceOfADeviceThatWasLostInAWriteFadesInFromZero) {
  publishPlane(20, 0, true);
  press(2);
  device_.next_write_error = ErrorCode::Lost;
  tick();
  clock_.advance(2s);
  device_.close();
  ASSERT_TRUE(device_.open() && device_.home() && device_.start());
  device_.position = {0, 0, -49.9};  // 3.9 mm into the end of the device's range
  task_->deviceIsBack();
  tick();
  EXPECT_LE(glm::length(device_.force), 0.05 + 1e-9) << "50 N/s";
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
}  // namespace relievo::test
