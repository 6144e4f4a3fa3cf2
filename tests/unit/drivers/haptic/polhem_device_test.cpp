// SPDX-License-Identifier: Apache-2.0
// Tests special to the Polhem's driver, on a model in simulated time: boards, calibration, currents.
#include "drivers/polhem/polhem.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "drivers/polhem/report.h"
#include "tests/support/device/model_port.h"
#include "tests/support/device/polhem_model.h"

namespace relievo {
namespace {

using polhem::kWoodenHaptics2019;
using polhem::Milliamps;
using test::Cable;
using test::PolhemModel;
using State = HapticDevice::State;

constexpr Duration kTick = std::chrono::milliseconds(1);

glm::dvec3 vectorOf(const Milliamps& m) {
  return {m[0], m[1], m[2]};
}

class PolhemDevice : public testing::Test {
 protected:
  std::unique_ptr<HapticDevice> make(PolhemModel& model, const polhem::Description& arm = kWoodenHaptics2019) {
    return makePolhem({.description = arm, .watchdog_thread = false},
                      std::make_unique<test::ModelPort>(model, cable_, clock_), clock_);
  }
  // Returns a Running device with the tip in the middle of the workspace.
  std::unique_ptr<HapticDevice> run(PolhemModel& model) {
    auto device = make(model);
    EXPECT_TRUE(device->open() && device->home());
    clock_.advance(std::chrono::milliseconds(100));
    EXPECT_TRUE(device->start());
    clock_.advance(kTick);
    for (int i = 0; i < 3; ++i) (void)tick(*device, {});
    return device;
  }
  void fadeIn(HapticDevice& device) {
    for (int i = 0; i < 600; ++i) (void)tick(device, {});
  }
  Result<HapticSample> tick(HapticDevice& device, const glm::dvec3& force_n) {
    auto sample = device.read();
    EXPECT_TRUE(!sample || device.write(force_n));
    clock_.advance(kTick);
    return sample;
  }
  Milliamps milliamps(const PolhemModel& model) { return model.milliamps(clock_.now()); }

  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  Cable cable_;
};

TEST_F(PolhemDevice, AnotherGadgetOfTheSameIdIsRefused) {
  PolhemModel keyboard(kWoodenHaptics2019, {.report_bytes = 8});
  const auto device = make(keyboard);
  EXPECT_EQ(device->open().error().code, ErrorCode::Unsupported);
  EXPECT_EQ(device->state(), State::Closed);
  EXPECT_FALSE(cable_.open);
}

TEST_F(PolhemDevice, ABoardThatSaysNothingTimesOut) {
  PolhemModel model;
  (void)model.read(clock_.now());  // reads the report that is ready after power-up
  model.silence();
  EXPECT_EQ(make(model)->open().error().code, ErrorCode::Timeout);
}

TEST_F(PolhemDevice, ABoardThatWaitsToBeAskedIsAsked) {
  PolhemModel model;
  (void)model.read(clock_.now());
  EXPECT_TRUE(make(model)->open());
}

TEST_F(PolhemDevice, CalibratesWithoutForceOnceTheArmIsHeldStill) {
  PolhemModel model;
  double still_s = 0;
  model.grip = [&](double t_s) {  // the user brings it there in a second
    const glm::dvec3 rest{0, 205, 25};
    if (!model.homed()) still_s = t_s;
    return t_s < 1 ? rest + glm::dvec3(40 * (1 - t_s), -60 * (1 - t_s), 0) : rest;
  };
  model.powerOn();
  const auto device = make(model);
  ASSERT_TRUE(device->open() && device->home());
  EXPECT_TRUE(model.homed());
  EXPECT_NEAR(still_s, 1.5, 0.1);
  for (const auto& each : model.history()) EXPECT_EQ(each, Milliamps{});
  ASSERT_TRUE(device->start());
  clock_.advance(kTick);
  EXPECT_LT(glm::distance(device->read()->position_mm, {0, 205, 25}), 0.1);
}

TEST_F(PolhemDevice, ABoardThatTakesAMomentToCalibrateIsWaitedFor) {
  PolhemModel model(kWoodenHaptics2019, {.calibrates_in = std::chrono::milliseconds(10)});
  const auto device = run(model);
  EXPECT_LT(glm::length(tick(*device, {})->position_mm), 0.15);
}

TEST_F(PolhemDevice, ABoardThatDoesNotKnowTheCommandIsCorrectedInTheDriver) {
  PolhemModel model(kWoodenHaptics2019, {.deaf_to_calibrate = true});
  const auto device = run(model);
  model.grip = [](double) { return glm::dvec3(10, -20, 30); };
  for (int i = 0; i < 4; ++i) (void)tick(*device, {});
  EXPECT_LT(glm::distance(tick(*device, {})->position_mm, {10, -20, 30}), 0.15) << "two counts' rounding";
  for (const auto& each : model.history()) EXPECT_EQ(each, Milliamps{});
}

TEST_F(PolhemDevice, TooMuchForOneMotorKeepsTheDirectionAndTheLimit) {
  polhem::Description weak = kWoodenHaptics2019;
  weak.torque_constant[0] = 0.02;
  weak.max_milliamps = 200;
  PolhemModel model(weak);
  const auto device = make(model, weak);
  ASSERT_TRUE(device->open() && device->home() && device->start());
  fadeIn(*device);
  const double peak_n = device->capabilities().peak_force_n;
  EXPECT_NEAR(peak_n, 0.291, 0.001) << "0.2 A x 0.02 N m/A x 16 on 220 mm";
  model.grip = [](double) { return glm::dvec3(0, 30, 90); };  // on 310 mm
  for (int i = 0; i < 5; ++i) (void)tick(*device, {});
  const glm::dvec3 at = tick(*device, {})->position_mm, wanted = peak_n * glm::normalize(glm::dvec3(1, 0.2, 0.1));
  (void)tick(*device, wanted);
  const Milliamps given = milliamps(model);
  EXPECT_EQ(std::max({std::abs(given[0]), std::abs(given[1]), std::abs(given[2])}), 200);
  const glm::dvec3 force = PolhemModel::forceOf(vectorOf(given), at, weak);
  EXPECT_NEAR(glm::length(force), 220.0 / 310 * peak_n / 0.976, 0.005) << "0.976: its share of x";
  EXPECT_GT(glm::dot(glm::normalize(force), glm::normalize(wanted)), 0.998);
}

TEST_F(PolhemDevice, ALoadThatLastsIsDerated) {
  polhem::Description weak = kWoodenHaptics2019;
  weak.max_milliamps = 1000;
  PolhemModel model(weak);
  const auto device = make(model, weak);
  ASSERT_TRUE(device->open() && device->home() && device->start());
  fadeIn(*device);
  const auto highest = [&] {
    (void)tick(*device, 2.9 * glm::dvec3(0, 0.616, 0.788));  // across the lower link, 38 degrees from upright
    const Milliamps m = milliamps(model);
    return std::max({std::abs(m[0]), std::abs(m[1]), std::abs(m[2])});
  };
  const int first = highest();
  EXPECT_NEAR(first, 982, 3);
  for (int i = 0; i < 120'000; ++i) (void)highest();
  EXPECT_GE(highest(), 500);
  EXPECT_LE(highest(), 613) << "a load that lasts settles at most 1.22 times above the half";
  device->stop();
  ASSERT_TRUE(device->start());
  fadeIn(*device);
  EXPECT_LE(highest(), 640) << "and is not forgotten with a start: half a second cools by a fortieth";
}

TEST_F(PolhemDevice, TheGripsButtonIsTheMainOne) {
  PolhemModel model;
  const auto device = run(model);
  EXPECT_EQ(tick(*device, {})->buttons, 0U);
  model.button = true;
  (void)tick(*device, {});
  EXPECT_EQ(tick(*device, {})->buttons, 1U);
}

TEST_F(PolhemDevice, ItsPeakIsWhatItsCurrentsHoldInEveryDirection) {
  PolhemModel model;
  EXPECT_EQ(make(model)->capabilities().peak_force_n, 5.0) << "2 A hold 5.9 N; the maker promises 5";
  EXPECT_NEAR(make(model)->capabilities().continuous_force_n, 2.95, 0.01) << "1 A";
  polhem::Description older = kWoodenHaptics2019;
  older.torque_constant = {0.0259, 0.0259, 0.0259};
  EXPECT_NEAR(make(model, older)->capabilities().peak_force_n, 2.537, 0.001);
  polhem::Description tame = kWoodenHaptics2019;
  tame.current_for_10_v_signal = 0.5;
  EXPECT_NEAR(make(model, tame)->capabilities().peak_force_n, 2.95 / 2, 0.01) << "amplifiers that are set to half an A";
}

}  // namespace
}  // namespace relievo
