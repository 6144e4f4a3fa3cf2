// SPDX-License-Identifier: Apache-2.0
// What only the Falcon's driver does, on a model of the device in simulated time: its firmware, its lights, its words.
#include "drivers/falcon/falcon.h"

#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>

#include "tests/support/falcon_model.h"
#include "tests/support/model_port.h"
#include "tests/support/usb_kinds.h"

namespace relievo {
namespace {

using test::Cable;
using test::FalconFaults;
using test::FalconModel;

constexpr Duration kTick = std::chrono::milliseconds(1);

class FalconDevice : public testing::Test {
 protected:
  std::unique_ptr<HapticDevice> make(FalconModel& model, std::string firmware = {}) {
    return makeFalcon({.firmware_path = std::move(firmware), .watchdog_thread = false},
                      std::make_unique<test::ModelPort>(model, cable_, clock_), clock_);
  }
  // Running, with the grip where the model has it.
  std::unique_ptr<HapticDevice> run(FalconModel& model) {
    model.runFirmware();
    auto device = make(model);
    EXPECT_TRUE(device->open() && device->home() && device->start());
    clock_.advance(kTick);
    return device;
  }
  void fadeIn(HapticDevice& device) {
    for (int i = 0; i < 600; ++i) tick(device, {});
  }
  Result<HapticSample> tick(HapticDevice& device, const glm::dvec3& force_n) {
    auto sample = device.read();
    EXPECT_TRUE(!sample || device.write(force_n));
    clock_.advance(kTick);
    return sample;
  }

  const test::FirmwareFile firmware_{2000};
  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  Cable cable_;
};

TEST_F(FalconDevice, UsesFirmwareThatRunsAlready) {
  FalconModel model(firmware_.image());
  model.runFirmware();
  const auto device = make(model);
  ASSERT_TRUE(device->open());
  EXPECT_EQ(model.loads(), 0);
}

TEST_F(FalconDevice, LoadsItsFirmware) {
  FalconModel model(firmware_.image());
  const auto device = make(model, firmware_.path());
  const auto opened = device->open();
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(model.running());
  EXPECT_EQ(model.loads(), 1);
}

TEST_F(FalconDevice, LoadsItAlsoWhenTheFirstTriesFailInEachWayThatUsersReport) {
  const FalconFaults ways[] = {
      {.silent_loads = 2}, {.wrong_echo_loads = 2},
      {.dead_loads = 2},   {.leading_zero = true},
      {.most_payload = 3}, {.silent_loads = 1, .wrong_echo_loads = 1, .dead_loads = 1, .leading_zero = true}};
  for (const FalconFaults& faults : ways) {
    FalconModel model(firmware_.image(), faults);
    const auto device = make(model, firmware_.path());
    const auto opened = device->open();
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(model.running());
    EXPECT_EQ(model.loads(), 1 + faults.silent_loads + faults.wrong_echo_loads + faults.dead_loads);
  }
}

TEST_F(FalconDevice, GivesUpOnADeviceThatNeverTakesIt) {
  FalconModel silent(firmware_.image(), {.silent_loads = 1000}), dead(firmware_.image(), {.dead_loads = 1000});
  EXPECT_EQ(make(silent, firmware_.path())->open().error().code, ErrorCode::Timeout);
  EXPECT_EQ(make(dead, firmware_.path())->open().error().code, ErrorCode::Corrupt);
  EXPECT_FALSE(cable_.open);
}

TEST_F(FalconDevice, ABootLoaderThatIsSilentIsNotWaitedForOnceItIsCalledOff) {
  FalconModel model(firmware_.image(), {.silent_loads = 1000});
  const auto device = make(model, firmware_.path());
  cable_ = {.instead = [&device] { device->cancel(); }, .verbs_left = 200};
  EXPECT_EQ(device->open().error().code, ErrorCode::Cancelled);
  EXPECT_LE(clock_.now() - cable_.pulled_at, std::chrono::milliseconds(100));
}

TEST_F(FalconDevice, GivesUpOnALineThatNeverStopsToBreak) {
  FalconModel model(firmware_.image(), {.broken_line = true});
  EXPECT_EQ(make(model, firmware_.path())->open().error().code, ErrorCode::Timeout);
  EXPECT_EQ(make(model)->open().error().code, ErrorCode::NotFound) << "no firmware answers";
}

TEST_F(FalconDevice, SaysWhatIsWrongWithTheFirmwaresFile) {
  FalconModel model(firmware_.image());
  EXPECT_EQ(make(model)->open().error().code, ErrorCode::NotFound);
  EXPECT_EQ(make(model, "/nowhere/firmware.bin")->open().error().code, ErrorCode::NotFound);
  std::ofstream(firmware_.path(), std::ios::trunc);
  EXPECT_EQ(make(model, firmware_.path())->open().error().code, ErrorCode::Corrupt);
  EXPECT_EQ(model.loads(), 0);
}

TEST_F(FalconDevice, HomesWithoutForceAndRedThenRunsGreen) {
  FalconModel model(firmware_.image());
  model.runFirmware();
  const auto device = make(model);
  ASSERT_TRUE(device->open() && device->home());
  EXPECT_TRUE(model.homed());
  for (const auto& words : model.history()) EXPECT_EQ(words, (falcon::Words{}));
  ASSERT_TRUE(device->start());
  EXPECT_TRUE(model.last().green);
  EXPECT_FALSE(model.last().red || model.last().homing);
}

TEST_F(FalconDevice, TheForceReachesTheMotorsWithinACount) {
  FalconModel model(firmware_.image());
  const auto device = run(model);
  fadeIn(*device);
  const glm::dvec3 at = device->read()->position_mm;
  for (const glm::dvec3& force :
       {glm::dvec3(2, 0, 0), glm::dvec3(0, -3, 0), glm::dvec3(1, 1, -2), glm::dvec3(0, 0, 5)}) {
    (void)tick(*device, force);
    const auto exact = -falcon::kDefaultCountsPerNm * 1e-3 * falcon::torquesOf(force, *falcon::inverse(at));
    for (std::size_t leg = 0; leg < 3; ++leg) {
      EXPECT_NEAR(model.last().motors[leg], exact[static_cast<int>(leg)], 0.51) << leg;
    }
    EXPECT_LT(glm::distance(FalconModel::forceOf(model.last().motors, at, falcon::kDefaultCountsPerNm), force), 0.003);
  }
}

}  // namespace
}  // namespace relievo
