// SPDX-License-Identifier: Apache-2.0
// The Polhem's driver on a model of the device, in simulated time: opening, calibration, exchange, every way to fail.
#include "drivers/polhem/polhem.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "drivers/polhem/report.h"
#include "tests/support/model_port.h"
#include "tests/support/polhem_model.h"

namespace relievo {
namespace {

using polhem::kWoodenHaptics2019;
using polhem::Milliamps;
using polhem::Verb;
using test::Cable;
using test::PolhemFaults;
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
  // Running, the tip in the middle of the workspace.
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
  glm::dvec3 felt(const PolhemModel& model, const glm::dvec3& place) {
    return PolhemModel::forceOf(vectorOf(milliamps(model)), place, kWoodenHaptics2019);
  }

  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  Cable cable_;
  HapticDevice* device_ = nullptr;  // for a model that acts on its driver
};

TEST_F(PolhemDevice, SpeaksToBoardsOfBothKinds) {
  for (const std::size_t bytes : {polhem::kReportBytes, polhem::kPaddedBytes}) {
    PolhemModel model(kWoodenHaptics2019, {.report_bytes = bytes});
    const auto device = run(model);
    fadeIn(*device);
    const auto sample = tick(*device, {1, 0, 0});
    ASSERT_TRUE(sample);
    EXPECT_LT(glm::length(sample->position_mm), 0.1);
    EXPECT_LT(glm::distance(felt(model, {0, 0, 0}), {1, 0, 0}), 0.01);
  }
}

TEST_F(PolhemDevice, AnotherGadgetOfTheSameIdIsRefused) {
  PolhemModel keyboard(kWoodenHaptics2019, {.report_bytes = 8});
  const auto device = make(keyboard);
  EXPECT_EQ(device->open().error().code, ErrorCode::Unsupported);
  EXPECT_EQ(device->state(), State::Closed);
  EXPECT_FALSE(cable_.open);
}

TEST_F(PolhemDevice, ABoardThatSaysNothingTimesOut) {
  PolhemModel model;
  (void)model.read(clock_.now());  // what waits after power-up is fetched
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
    if (!model.calibrated()) still_s = t_s;
    return t_s < 1 ? rest + glm::dvec3(40 * (1 - t_s), -60 * (1 - t_s), 0) : rest;
  };
  model.powerOn();
  const auto device = make(model);
  ASSERT_TRUE(device->open() && device->home());
  EXPECT_TRUE(model.calibrated());
  EXPECT_NEAR(still_s, 1.5, 0.1);
  for (const auto& each : model.history()) EXPECT_EQ(each, Milliamps{});
  ASSERT_TRUE(device->start());
  clock_.advance(kTick);
  EXPECT_LT(glm::distance(device->read()->position_mm, {0, 205, 25}), 0.1);
}

TEST_F(PolhemDevice, ABoardThatDoesNotKnowTheCommandIsCorrectedInTheDriver) {
  PolhemModel model(kWoodenHaptics2019, {.deaf_to_calibrate = true});
  const auto device = run(model);
  model.grip = [](double) { return glm::dvec3(10, -20, 30); };
  for (int i = 0; i < 4; ++i) (void)tick(*device, {});
  EXPECT_LT(glm::distance(tick(*device, {})->position_mm, {10, -20, 30}), 0.15) << "two counts' rounding";
  for (const auto& each : model.history()) EXPECT_EQ(each, Milliamps{});
}

TEST_F(PolhemDevice, ACalibrationThatNobodyHelpsEndsWhenItIsCalledOff) {
  PolhemModel model;
  model.grip = [&](double t_s) {
    if (t_s > 3) device_->cancel();
    return glm::dvec3(0, 30 * std::sin(9 * t_s), 0);
  };
  auto device = make(model);
  device_ = device.get();
  ASSERT_TRUE(device->open());
  EXPECT_EQ(device->home().error().code, ErrorCode::Cancelled);
  EXPECT_FALSE(model.calibrated());
  device->close();
  EXPECT_TRUE(device->open()) << "closing forgets the call";
}

TEST_F(PolhemDevice, ThePositionIsTheTipsWithinACount) {
  PolhemModel model;
  const auto device = run(model);
  model.grip = [](double t_s) {
    return glm::dvec3(60 * std::sin(2 * t_s), 50 * std::sin(3 * t_s + 1), 55 * std::sin(1.3 * t_s));
  };
  for (int i = 0; i < 20; ++i) (void)tick(*device, {});
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 answered = model.gripNow(clock_.now() - kTick + std::chrono::microseconds(300));
    const auto sample = tick(*device, {});
    ASSERT_TRUE(sample);
    worst = std::max(worst, glm::distance(sample->position_mm, answered));
  }
  EXPECT_LT(worst, 0.1) << "half a count of each body";
}

TEST_F(PolhemDevice, TheForceReachesTheHandWithinAMilliamp) {
  PolhemModel model;
  const auto device = run(model);
  fadeIn(*device);
  const glm::dvec3 at = device->read()->position_mm;
  for (const glm::dvec3& force :
       {glm::dvec3(2, 0, 0), glm::dvec3(0, -3, 0), glm::dvec3(1, 1, -2), glm::dvec3(0, 0, 5)}) {
    (void)tick(*device, force);
    // Half a milliamp of body a: 0.321 x 16 N m/A on 0.22 m, 0.012 N.
    EXPECT_LT(glm::distance(felt(model, at), force), 0.015);
  }
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
}

TEST_F(PolhemDevice, TheForceFadesInAfterStart) {
  PolhemModel model;
  const auto device = run(model);
  double before = 0;
  for (int i = 0; i < 500; ++i) {
    const auto at = tick(*device, {0, 0, 4})->position_mm;
    const double now = felt(model, at).z;
    ASSERT_LE(now - before, 0.05) << "4 N in half a second are 8 mN a tick, and a milliamp's rounding";
    before = now;
  }
  EXPECT_NEAR(before, 4, 0.05);
}

TEST_F(PolhemDevice, TheGripsButtonIsTheMainOne) {
  PolhemModel model;
  const auto device = run(model);
  EXPECT_EQ(tick(*device, {})->buttons, 0U);
  model.button = true;
  (void)tick(*device, {});
  EXPECT_EQ(tick(*device, {})->buttons, 1U);
}

TEST_F(PolhemDevice, ATickAllocatesNothing) {
  PolhemModel model;
  const auto device = run(model);
  const auto own = [&] { return threadAllocations() - cable_.model_allocations; };
  const auto before = own();
  for (int i = 0; i < 1000; ++i) {
    (void)device->read();
    (void)device->write({0, 0, 1});
    clock_.advance(kTick);
  }
  EXPECT_EQ(own(), before);
}

// No checksum guards a report. What is asked: a position that was never there is not taken for one, and no current
// beyond the limit goes out.
TEST_F(PolhemDevice, CorruptShortAndLongReportsMakeNoWrongPositionAndNoWildForce) {
  std::mt19937 random(99);
  bool spoiling = false;
  int spoiled = 0;
  const auto below = [&random](unsigned n) { return random() % n; };
  PolhemFaults faults;
  faults.spoil = [&](std::vector<std::uint8_t>& bytes) {
    if (!spoiling || below(4) != 0) return;
    ++spoiled;
    switch (below(4)) {
      case 0:  // another byte of the three that matter most
        bytes[1 + 2 * below(3)] = static_cast<std::uint8_t>(random());
        break;
      case 1:  // a burst
        for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
        break;
      case 2:  // a part is lost
        bytes.erase(bytes.begin() + 1 + below(13), bytes.end());
        break;
      default:  // more than there should be
        bytes.resize(15 + below(50), static_cast<std::uint8_t>(random()));
    }
  };
  PolhemModel model(kWoodenHaptics2019, faults);
  const auto device = run(model);
  fadeIn(*device);
  model.grip = [](double t_s) {
    return glm::dvec3(40 * std::sin(4 * t_s), 40 * std::sin(5 * t_s), 40 * std::sin(3 * t_s));
  };
  for (int i = 0; i < 50; ++i) (void)tick(*device, {});
  spoiling = true;
  double worst = 0;
  int held = 0;
  for (int i = 0; i < 10'000; ++i) {
    const glm::dvec3 answered = model.gripNow(clock_.now() - kTick + std::chrono::microseconds(300));
    const auto sample = tick(*device, {0, 0, 5});
    ASSERT_TRUE(sample) << sample.error().message;
    const double off = glm::distance(sample->position_mm, answered);
    held += off > 0.2 ? 1 : 0;  // a tick without a good report shows an older place: up to 0.3 mm a tick
    worst = std::max(worst, off);
    for (const std::int16_t each : milliamps(model)) ASSERT_LE(std::abs(each), 2000);
  }
  EXPECT_GT(spoiled, 2000);
  EXPECT_LT(worst, 1.5);
  EXPECT_LT(held, 3500);
}

TEST_F(PolhemDevice, IsLostWhenItSaysNothingAnyMore) {
  PolhemModel model;
  const auto device = run(model);
  model.silence();
  int ticks = 0;
  while (device->state() == State::Running && ticks < 1000) (void)tick(*device, {0, 0, 1}), ++ticks;
  EXPECT_EQ(device->state(), State::Lost);
  EXPECT_NEAR(ticks, 101, 2);
}

TEST_F(PolhemDevice, IsLostWhenItFallsSilentWhileItIsCalibrated) {
  PolhemModel model;
  auto device = make(model);
  ASSERT_TRUE(device->open());
  model.silence();
  EXPECT_EQ(device->home().error().code, ErrorCode::Lost);
  EXPECT_EQ(device->state(), State::Lost);
}

TEST_F(PolhemDevice, AForceThatNobodyRenewsEnds) {
  PolhemModel model;
  const auto device = run(model);
  fadeIn(*device);
  (void)tick(*device, {0, 0, 3});
  EXPECT_NE(milliamps(model), Milliamps{});
  clock_.advance(std::chrono::milliseconds(18));
  ASSERT_TRUE(device->read());
  EXPECT_NE(milliamps(model), Milliamps{}) << "one late tick is not yet a reason";
  clock_.advance(std::chrono::milliseconds(4));
  ASSERT_TRUE(device->read());
  EXPECT_EQ(milliamps(model), Milliamps{});
  ASSERT_TRUE(device->write({0, 0, 3}));
  EXPECT_LT(felt(model, {0, 0, 0}).z, 0.3) << "it fades in anew";
}

TEST_F(PolhemDevice, ForceIsZeroAfterStopCloseAndTheEnd) {
  PolhemModel model;
  const auto push = [&](HapticDevice& device) {
    fadeIn(device);
    (void)tick(device, {0, 0, 3});
    EXPECT_NE(milliamps(model), Milliamps{});
  };
  auto device = run(model);
  push(*device);
  device->stop();
  EXPECT_EQ(milliamps(model), Milliamps{});
  ASSERT_TRUE(device->start());
  push(*device);
  device->close();
  EXPECT_EQ(milliamps(model), Milliamps{});
  EXPECT_FALSE(cable_.open || cable_.exchanging);
  device.reset();
  model.powerOn();
  device = run(model);
  push(*device);
  device.reset();
  EXPECT_EQ(milliamps(model), Milliamps{});
}

// The cable is pulled at the first verb of the port, then at the second, and so on through the whole life; then it is
// plugged in and everything works.
TEST_F(PolhemDevice, UnpluggedAtAnyMomentItIsCleanAndComesBack) {
  const auto live = [&](HapticDevice& device) -> Result<void> {
    if (auto opened = device.open(); !opened) return opened;
    if (auto homed = device.home(); !homed) return homed;
    if (auto started = device.start(); !started) return started;
    for (int i = 0; i < 30; ++i) {
      clock_.advance(kTick);
      if (auto sample = device.read(); !sample) return std::unexpected(sample.error());
      if (auto written = device.write({0, 0, 1}); !written) return written;
    }
    device.stop();
    return {};
  };
  int moment = 1;
  for (bool whole = false; !whole; ++moment) {
    PolhemModel model;
    cable_ = Cable{.verbs_left = moment};
    const auto device = make(model);
    const auto lived = live(*device);
    whole = lived.has_value();
    if (!whole) {
      ASSERT_TRUE(lived.error().code == ErrorCode::Lost || lived.error().code == ErrorCode::NotFound) << moment;
    }
    device->close();
    ASSERT_EQ(device->state(), State::Closed);
    ASSERT_FALSE(cable_.open || cable_.exchanging) << moment;
    // Every moment of the wait is like its neighbours: only some of them are tried again whole.
    if (moment % 7 != 0 && moment > 40) continue;
    cable_ = Cable{};
    model.powerOn();
    const auto again = live(*device);
    ASSERT_TRUE(again) << moment << ": " << again.error().message;
    device->close();
  }
  EXPECT_GT(moment, 1000);
}

TEST_F(PolhemDevice, ItsPeakIsWhatItsCurrentsHoldInEveryDirection) {
  PolhemModel model;
  EXPECT_EQ(make(model)->capabilities().peak_force_n, 5.0) << "2 A hold 5.9 N; the maker promises 5";
  EXPECT_NEAR(make(model)->capabilities().continuous_force_n, 2.95, 0.01) << "1 A";
  polhem::Description older = kWoodenHaptics2019;
  older.torque_constant = {0.0259, 0.0259, 0.0259};
  EXPECT_NEAR(make(model, older)->capabilities().peak_force_n, 2.537, 0.001);
}

}  // namespace
}  // namespace relievo
