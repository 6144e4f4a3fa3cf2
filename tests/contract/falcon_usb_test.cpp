// SPDX-License-Identifier: Apache-2.0
// The Falcon's driver over the real libusb and usbfs's requests, on a model that is plugged
// into the machine: by umockdev, and in a guest by the kernel itself.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <random>

#include "drivers/falcon/falcon.h"
#include "drivers/falcon/link.h"
#include "tests/support/falcon_model.h"
#include "tests/support/plugged_usb.h"

namespace relievo {
namespace {

using test::FalconModel;
using State = HapticDevice::State;

constexpr Duration kTick = std::chrono::milliseconds(1);

std::vector<std::uint8_t> image() {
  std::vector<std::uint8_t> bytes(1000);
  std::mt19937 random(7);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

class FalconUsb : public testing::Test {
 protected:
  void SetUp() override {
    if (usb_ == nullptr) GTEST_SKIP() << test::kNoPlug;
  }
  falcon::Words words() {
    const std::lock_guard guard(usb_->lock());
    return model_.last().motors;
  }
  std::unique_ptr<HapticDevice> make(std::string firmware = {}) {
    return makeFalcon({.firmware_path = std::move(firmware)}, clock_);
  }
  std::unique_ptr<HapticDevice> run() {
    model_.runFirmware();
    auto device = make();
    const auto opened = device->open();
    EXPECT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(device->home() && device->start());
    return device;
  }

  FalconModel model_{image()};
  std::unique_ptr<test::PluggedUsb> usb_ = test::plugIn(model_, falcon::kUsbId);
  MonotonicClock clock_;
};

TEST_F(FalconUsb, LoadsItsFirmwareThroughLibusb) {
  const auto path = std::filesystem::temp_directory_path() / "relievo-usb-firmware.bin";
  const auto bytes = image();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const auto device = make(path);
  const auto opened = device->open();
  std::filesystem::remove(path);
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(model_.running());
  EXPECT_EQ(usb_->unknownRequests(), 0);
}

TEST_F(FalconUsb, ExchangesAThousandTicksAndCountsNoneTwice) {
  const auto device = run();
  const int before = model_.commands();
  MonotonicTime next = clock_.now();
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto sample = device->read();
    ASSERT_TRUE(sample) << sample.error().message;
    worst = std::max(worst, glm::distance(sample->position_mm, {0, 0, 120}));
    ASSERT_TRUE(device->write({0, 0, 2}));
    next += kTick;
    clock_.sleepUntil(next);
  }
  EXPECT_LT(worst, 0.1);
  const glm::dvec3 felt = FalconModel::forceOf(words(), {0, 0, 120}, falcon::kDefaultCountsPerNm);
  EXPECT_NEAR(felt.z, 2, 0.02);
  device->stop();
  EXPECT_EQ(words(), falcon::Words{});
  // A guest's time is virtual; a mocked machine may be busy.
  if (!test::machineIsMocked()) {
    EXPECT_GT(model_.commands() - before, 950) << "of a thousand";
  }
  EXPECT_EQ(usb_->unknownRequests(), 0);
}

TEST_F(FalconUsb, UnpluggedInUseItIsLostAndComesBack) {
  const auto device = run();
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(device->read() && device->write({0, 0, 2}));
    clock_.sleepUntil(clock_.now() + kTick);
  }
  usb_->unplug();
  for (int i = 0; i < 100 && device->state() == State::Running; ++i) {
    (void)device->read();
    (void)device->write({0, 0, 2});
  }
  EXPECT_EQ(device->state(), State::Lost);
  device->close();
  EXPECT_EQ(device->open().error().code, ErrorCode::NotFound);
  model_.powerOn();
  model_.runFirmware();
  usb_->plug();
  const auto opened = device->open();
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(device->home() && device->start());
  EXPECT_TRUE(device->read());
}

TEST_F(FalconUsb, TheWatchdogStopsTheMotorsOfATaskThatHangs) {
  const auto device = run();
  for (int i = 0; i < 600; ++i) {
    ASSERT_TRUE(device->read() && device->write({0, 0, 2}));
    clock_.sleepUntil(clock_.now() + kTick);
  }
  EXPECT_NE(words(), falcon::Words{});
  clock_.sleepUntil(clock_.now() + std::chrono::milliseconds(500));  // no read, no write
  EXPECT_EQ(words(), falcon::Words{});
}

TEST_F(FalconUsb, AFatalSignalsHandlerStopsTheMotors) {
  const auto device = run();
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(device->read() && device->write({0, 0, 5}));
    clock_.sleepUntil(clock_.now() + kTick);
  }
  EXPECT_NE(words(), falcon::Words{});
  quietenAllUsbDevices();
  EXPECT_EQ(words(), falcon::Words{});
  device->close();
  quietenAllUsbDevices();  // nobody is listed any more
}

}  // namespace
}  // namespace relievo
