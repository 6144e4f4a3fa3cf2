// SPDX-License-Identifier: Apache-2.0
// Tests special to the Falcon's driver, on a model in simulated time: firmware, lights, motor words.
#include "drivers/falcon/falcon.h"

#include <gtest/gtest.h>

#include <deque>
#include <fstream>
#include <glm/geometric.hpp>

#include "tests/support/device/falcon_model.h"
#include "tests/support/device/model_port.h"
#include "tests/support/device/usb/usb_kinds.h"

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
  // Returns a Running device whose grip is held by the model.
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

// After a short power failure the device needs homing again, and its counts are meaningless.
TEST_F(FalconDevice, WithoutItsZeroItIsLost) {
  FalconModel model(firmware_.image());
  const auto device = run(model);
  fadeIn(*device);
  const glm::dvec3 before = device->read()->position_mm;
  model.powerOn();
  model.runFirmware();
  int ticks = 0;
  for (; device->state() == HapticDevice::State::Running && ticks < 100; ++ticks) {
    if (const auto sample = tick(*device, {0, 0, 1})) {
      EXPECT_EQ(sample->position_mm, before);
    }
  }
  EXPECT_LE(ticks, 5);
  EXPECT_EQ(model.last().motors, (falcon::Words{})) << "no force from the moment of the loss";
  device->close();
  EXPECT_FALSE(model.pushes(clock_.now()));
}

// Splits each reply of a Falcon in two, with a packet between the parts that reports lost bytes.
class BrokenLine final : public test::UsbModel {
 public:
  explicit BrokenLine(FalconModel& falcon) : falcon_(falcon) {}
  bool broken = false;
  void control(std::uint8_t request, std::uint16_t value, MonotonicTime now) override {
    falcon_.control(request, value, now);
  }
  void write(UsbBytes bytes, MonotonicTime now) override { falcon_.write(bytes, now); }
  std::optional<UsbPacket> read(MonotonicTime now) override {
    if (parts_.empty()) {
      const auto whole = falcon_.read(now);
      if (!broken || !whole || whole->bytes < 18) return whole;
      UsbPacket first = *whole, lost = *whole, last = *whole;
      first.bytes = 10;
      lost.data[1] |= 0x02;  // overrun
      lost.bytes = 3;
      std::copy_n(whole->data.begin() + 10, 8, last.data.begin() + 2);
      last.bytes = 10;
      parts_ = {first, lost, last};
    }
    const UsbPacket part = parts_.front();
    parts_.pop_front();
    return part;
  }

 private:
  FalconModel& falcon_;
  std::deque<UsbPacket> parts_;
};

TEST_F(FalconDevice, NoAnswerSpansAPacketThatIsBroken) {
  FalconModel model(firmware_.image());
  model.runFirmware();
  BrokenLine line(model);
  const auto device =
      makeFalcon({.watchdog_thread = false}, std::make_unique<test::ModelPort>(line, cable_, clock_), clock_);
  ASSERT_TRUE(device->open() && device->home() && device->start());
  for (int i = 0; i < 10; ++i) (void)tick(*device, {});
  line.broken = true;
  int ticks = 0;
  while (device->state() == HapticDevice::State::Running && ticks < 200) (void)tick(*device, {}), ++ticks;
  EXPECT_EQ(device->state(), HapticDevice::State::Lost) << "there was no answer for 100 ms";
}

}  // namespace
}  // namespace relievo
