// SPDX-License-Identifier: Apache-2.0
// The Polhem's driver over the real libusb and usbfs's requests, on a model that is plugged
// into the machine: by umockdev, and in a guest by the kernel itself.
#include <gtest/gtest.h>

#include <cstdlib>
#include <glm/geometric.hpp>

#include "drivers/polhem/polhem.h"
#include "drivers/polhem/report.h"
#include "tests/support/plugged_usb.h"
#include "tests/support/polhem_model.h"

namespace relievo {
namespace {

using polhem::kWoodenHaptics2019;
using polhem::Milliamps;
using test::PolhemModel;
using State = HapticDevice::State;

constexpr Duration kTick = std::chrono::milliseconds(1);

struct Board {
  const char* name;
  UsbDeviceId id;
  std::size_t report_bytes;
};
constexpr Board kBoards[] = {{"mbed", polhem::kMbedId, polhem::kReportBytes},
                             {"teensy", polhem::kTeensyId, polhem::kPaddedBytes}};

// On a machine with that board plugged in.
class PolhemUsb : public testing::Test {
 protected:
  explicit PolhemUsb(const Board& board = kBoards[0])
      : model_(kWoodenHaptics2019, {.report_bytes = board.report_bytes}), usb_(test::plugIn(model_, board.id)) {}
  void SetUp() override {
    if (usb_ == nullptr) GTEST_SKIP() << test::kNoPlug;
  }
  // What it was told last.
  Milliamps milliamps() {
    const std::lock_guard guard(usb_->lock());
    return model_.last().motors;
  }
  std::unique_ptr<HapticDevice> run() {
    auto device = makePolhem({}, clock_);
    const auto opened = device->open();
    EXPECT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(device->home() && device->start());
    return device;
  }
  void push(HapticDevice& device, int ticks, const glm::dvec3& force_n) {
    for (int i = 0; i < ticks; ++i) {
      ASSERT_TRUE(device.read() && device.write(force_n));
      clock_.sleepUntil(clock_.now() + kTick);
    }
  }

  PolhemModel model_;
  std::unique_ptr<test::PluggedUsb> usb_;
  MonotonicClock clock_;
};

class PolhemUsbBoards : public PolhemUsb, public testing::WithParamInterface<int> {
 protected:
  PolhemUsbBoards() : PolhemUsb(kBoards[GetParam()]) {}
};
INSTANTIATE_TEST_SUITE_P(Boards, PolhemUsbBoards, testing::Values(0, 1),
                         [](const auto& test) { return std::string(kBoards[test.param].name); });

TEST_P(PolhemUsbBoards, ExchangesAReportForEveryTick) {
  constexpr int kTicks = 300;
  const auto device = run();
  const int before = model_.commands();
  push(*device, kTicks, {0, 0, 2});
  const auto sample = device->read();
  ASSERT_TRUE(sample);
  EXPECT_LT(glm::length(sample->position_mm), 0.1);
  const Milliamps now = milliamps();
  const glm::dvec3 force = PolhemModel::forceOf({now[0], now[1], now[2]}, {0, 0, 0}, kWoodenHaptics2019);
  EXPECT_GT(force.z, 0) << "it is fading in";
  EXPECT_LT(force.z, 2.02);
  EXPECT_NEAR(force.x, 0, 0.02);
  EXPECT_NEAR(force.y, 0, 0.02);
  device->stop();
  EXPECT_EQ(milliamps(), Milliamps{});
  EXPECT_GT(model_.commands() - before, kTicks);
  EXPECT_EQ(usb_->unknownRequests(), 0);
}

TEST_F(PolhemUsb, UnpluggedInUseItIsLostAndComesBack) {
  const auto device = run();
  push(*device, 20, {0, 0, 2});
  usb_->unplug();
  for (int i = 0; i < 100 && device->state() == State::Running; ++i) {
    (void)device->read();
    (void)device->write({0, 0, 2});
  }
  EXPECT_EQ(device->state(), State::Lost);
  device->close();
  EXPECT_EQ(device->open().error().code, ErrorCode::NotFound);
  model_.powerOn();
  usb_->plug();
  const auto opened = device->open();
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(device->home() && device->start());
  EXPECT_TRUE(device->read());
}

TEST_F(PolhemUsb, TheWatchdogStopsTheMotorsOfATaskThatHangs) {
  const auto device = run();
  push(*device, 200, {0, 0, 2});
  EXPECT_NE(milliamps(), Milliamps{});
  clock_.sleepUntil(clock_.now() + std::chrono::milliseconds(500));  // no read, no write
  EXPECT_EQ(milliamps(), Milliamps{});
}

TEST_F(PolhemUsb, AFatalSignalsHandlerStopsTheMotors) {
  const auto device = run();
  push(*device, 200, {0, 0, 4});
  EXPECT_NE(milliamps(), Milliamps{});
  quietenAllUsbDevices();
  EXPECT_EQ(milliamps(), Milliamps{});
}

}  // namespace
}  // namespace relievo
