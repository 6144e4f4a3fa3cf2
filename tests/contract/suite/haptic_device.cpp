// SPDX-License-Identifier: Apache-2.0
// The cases of the haptic device's contract.
#include "tests/contract/suite/haptic_device.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>

#include "platform/allocation_counter.h"
#include "tests/contract/state_table.h"

namespace relievo {

using Rig = test::HapticRig;

namespace {
constexpr Duration kTick = std::chrono::milliseconds(1);
}

bool test::hapticDeviceCases() {
  return true;
}
// Without this line a program fails that the linker gives this file only for an inline function of the standard
// library.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(HapticDeviceContract);

Rig HapticDeviceContract::bring(State state) {
  const auto& make = state == State::Lost ? GetParam().make_losing : GetParam().make;
  if (make == nullptr) return {};
  Rig rig = make(clock_);
  benches_.push_back(rig.bench);
  HapticDevice& device = *rig.device;
  if (state == State::Closed) return rig;
  EXPECT_TRUE(device.open());
  if (state == State::Opened) return rig;
  EXPECT_TRUE(device.home());
  if (state == State::Ready) return rig;
  EXPECT_TRUE(device.start());
  EXPECT_TRUE(state != State::Lost || device.read().error().code == ErrorCode::Lost);
  return rig;
}

Rig HapticDeviceContract::pushing() {
  Rig rig = bring(State::Running);
  for (int i = 0; i < rig.ticks_to_push; ++i) {
    if (i > 0) clock_.advance(kTick);
    EXPECT_TRUE(rig.device->read());
    EXPECT_TRUE(rig.device->write({1, 0, 0}));
  }
  return rig;
}

TEST_P(HapticDeviceContract, EveryVerbInEveryState) {
  const std::vector<test::Verb<HapticDevice>> verbs = {
      {"open", [](HapticDevice& d) { return test::answerOf(d.open()); }},
      {"home", [](HapticDevice& d) { return test::answerOf(d.home()); }},
      {"start", [](HapticDevice& d) { return test::answerOf(d.start()); }},
      {"read", [](HapticDevice& d) { return test::answerOf(d.read()); }},
      {"write", [](HapticDevice& d) { return test::answerOf(d.write({0, 0, 1})); }},
      {"stop", [](HapticDevice& d) { return d.stop(), test::Answer{}; }},
      {"close", [](HapticDevice& d) { return d.close(), test::Answer{}; }},
  };
  constexpr auto no = std::nullopt;
  const std::vector<test::Row<State>> table = {
      // from           open           home          start           read            write         stop close
      {State::Closed, {State::Opened, no, no, no, no, State::Closed, State::Closed}},
      {State::Opened, {no, State::Ready, no, no, no, State::Opened, State::Closed}},
      {State::Ready, {no, State::Ready, State::Running, no, no, State::Ready, State::Closed}},
      {State::Running, {no, no, no, State::Running, State::Running, State::Ready, State::Closed}},
      {State::Lost, {no, no, no, no, no, State::Lost, State::Closed}},
  };
  test::expectStateTable(verbs, table, [&](State state) { return std::move(bring(state).device); });
}

TEST_P(HapticDeviceContract, CapabilitiesAreSensibleAndStayTheSame) {
  const Rig rig = bring(State::Opened);
  HapticDevice& device = *rig.device;
  const HapticCapabilities first = device.capabilities();
  EXPECT_STRNE(first.name, "");
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(first.workspace_min_mm[axis], first.workspace_max_mm[axis]);
  EXPECT_GT(first.peak_force_n, 0);
  EXPECT_GT(first.continuous_force_n, 0);
  EXPECT_LE(first.continuous_force_n, first.peak_force_n);
  EXPECT_GT(first.max_stiffness_n_per_mm, 0);
  EXPECT_GT(first.rate_hz, 0);

  const auto expectSame = [&] {
    const HapticCapabilities now = device.capabilities();
    EXPECT_STREQ(now.name, first.name);
    EXPECT_EQ(now.workspace_min_mm, first.workspace_min_mm);
    EXPECT_EQ(now.workspace_max_mm, first.workspace_max_mm);
    EXPECT_EQ(now.peak_force_n, first.peak_force_n);
    EXPECT_EQ(now.continuous_force_n, first.continuous_force_n);
    EXPECT_EQ(now.max_stiffness_n_per_mm, first.max_stiffness_n_per_mm);
    EXPECT_EQ(now.rate_hz, first.rate_hz);
  };
  ASSERT_TRUE(device.home());
  expectSame();
  ASSERT_TRUE(device.start());
  ASSERT_TRUE(device.read());
  ASSERT_TRUE(device.write({0, 0, 1}));
  expectSame();
  device.stop();
  expectSame();
}

TEST_P(HapticDeviceContract, ARateIsTakenOrTheMostThatItCan) {
  const Rig usual = bring(State::Opened);
  const HapticCapabilities own = usual.device->capabilities();
  EXPECT_EQ(usual.device->setRate(500).error().code, ErrorCode::InvalidState);
  for (const double hz : {500.0, 1000.0, 4000.0, 8000.0}) {
    const Rig rig = bring(State::Closed);
    HapticDevice& device = *rig.device;
    const auto rate = device.setRate(hz);
    ASSERT_TRUE(rate);
    EXPECT_TRUE(*rate == hz || *rate >= own.rate_hz) << hz << ": " << *rate;
    EXPECT_EQ(device.capabilities().rate_hz, *rate);
    if (*rate < own.rate_hz) {
      EXPECT_LE(device.capabilities().max_stiffness_n_per_mm, own.max_stiffness_n_per_mm);
    }
    ASSERT_TRUE(device.open() && device.home() && device.start());
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(device.read());
      ASSERT_TRUE(device.write({0, 0, 1}));
      clock_.advance(fromSeconds(1 / *rate));
    }
    EXPECT_EQ(device.capabilities().rate_hz, *rate);
  }
}

TEST_P(HapticDeviceContract, TheFingerIsInsideTheWorkspace) {
  const Rig rig = bring(State::Running);
  const HapticCapabilities capabilities = rig.device->capabilities();
  for (int i = 0; i < 100; ++i) {
    const auto sample = rig.device->read();
    ASSERT_TRUE(sample);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(sample->position_mm[axis], capabilities.workspace_min_mm[axis]);
      ASSERT_LE(sample->position_mm[axis], capabilities.workspace_max_mm[axis]);
    }
    clock_.advance(kTick);
  }
}

TEST_P(HapticDeviceContract, AForceArrives) {
  if (!GetParam().has_motors) GTEST_SKIP() << "this back end has no motors";
  EXPECT_TRUE(pushing().pushes());
}

TEST_P(HapticDeviceContract, ExactlyThePeakIsAllowedInAnyDirection) {
  const Rig rig = bring(State::Running);
  const double peak_n = rig.device->capabilities().peak_force_n;
  for (const glm::dvec3& direction : {glm::dvec3(1, 0, 0), glm::dvec3(2, -3, 6) / 7.0, glm::dvec3(-1, 4, -8) / 9.0}) {
    EXPECT_TRUE(rig.device->write(peak_n * direction));
  }
}

TEST_P(HapticDeviceContract, AForceThatIsNoneOrTooMuchIsRefusedAndZeroIsSent) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double peak_n = bring(State::Closed).device->capabilities().peak_force_n;
  for (const glm::dvec3& force : {glm::dvec3(nan, 0, 0), glm::dvec3(0, nan, 0), glm::dvec3(0, 0, nan),
                                  glm::dvec3(infinity, 0, 0), glm::dvec3(0, 0, -infinity), glm::dvec3(1e200, 0, 0),
                                  glm::dvec3(0, peak_n * 1.001, 0), glm::dvec3(0.6 * peak_n)}) {
    SCOPED_TRACE(testing::Message() << force.x << ", " << force.y << ", " << force.z);
    const Rig rig = pushing();
    const auto written = rig.device->write(force);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::InvalidArgument);
    EXPECT_EQ(rig.device->state(), State::Running);
    EXPECT_FALSE(rig.pushes());
    EXPECT_TRUE(rig.device->write({1, 0, 0})) << "the next one goes through";
  }
}

TEST_P(HapticDeviceContract, DoesNotPushBeforeTheFirstForce) {
  const Rig rig = bring(State::Running);
  ASSERT_TRUE(rig.device->read());
  EXPECT_FALSE(rig.pushes());
}

TEST_P(HapticDeviceContract, DoesNotPushAfterStop) {
  const Rig rig = pushing();
  rig.device->stop();
  EXPECT_FALSE(rig.pushes());
}

TEST_P(HapticDeviceContract, DoesNotPushAfterClose) {
  const Rig rig = pushing();
  rig.device->close();
  EXPECT_FALSE(rig.pushes());
}

TEST_P(HapticDeviceContract, DoesNotPushWhenForcesNoLongerCome) {
  const Rig rig = pushing();
  for (int i = 0; i < 2; ++i) {  // in the second second a moving mass comes to rest
    clock_.advance(std::chrono::seconds(1));
    ASSERT_TRUE(rig.device->read());
  }
  EXPECT_FALSE(rig.pushes());
}

TEST_P(HapticDeviceContract, IsAsNewAfterCloseAndOpen) {
  const Rig rig = pushing();
  rig.device->close();
  ASSERT_TRUE(rig.device->open());
  EXPECT_EQ(rig.device->state(), State::Opened);
  ASSERT_TRUE(rig.device->home() && rig.device->start());
  EXPECT_TRUE(rig.device->read());
}

TEST_P(HapticDeviceContract, AnExchangeAllocatesNothing) {
  const Rig rig = bring(State::Running);
  ASSERT_TRUE(rig.device->read());
  const auto own = [&rig] { return threadAllocations() - rig.allocations(); };
  const std::uint64_t before = own();
  for (int i = 0; i < 10; ++i) {
    (void)rig.device->read();
    (void)rig.device->write({0, 0, 1});
    (void)rig.device->write({0, 0, 1000});
    clock_.advance(kTick);
  }
  EXPECT_EQ(own(), before);
}

TEST_P(HapticDeviceContract, ALostDeviceIsLostUntilClosedAndPushesNobody) {
  if (GetParam().make_losing == nullptr) GTEST_SKIP() << "this back end cannot be lost";
  const Rig rig = bring(State::Lost);
  EXPECT_FALSE(rig.pushes());
  EXPECT_EQ(rig.device->read().error().code, ErrorCode::InvalidState);
  rig.device->close();
  EXPECT_TRUE(rig.device->open());
}

}  // namespace relievo
