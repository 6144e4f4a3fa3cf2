// SPDX-License-Identifier: Apache-2.0
// Drivers of haptic devices over the real libusb and usbfs requests, on models that umockdev simulates, or the kernel's
// virtual host controller in a guest.
#include <gtest/gtest.h>

#include <filesystem>
#include <glm/geometric.hpp>
#include <iterator>

#include "drivers/falcon/falcon.h"
#include "drivers/falcon/link.h"
#include "tests/support/device/falcon_model.h"
#include "tests/support/device/usb/umockdev_usb.h"
#include "tests/support/device/usb/usb_kinds.h"

namespace relievo {
namespace {

using test::FalconFaults;
using test::FalconModel;
using test::HapticModel;
using test::UsbKind;
using State = HapticDevice::State;

constexpr Duration kTick = std::chrono::milliseconds(1);

std::ptrdiff_t openDescriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return std::distance(begin(all), end(all));
}

// With a model of that device plugged in.
class HapticUsb : public testing::TestWithParam<UsbKind> {
 protected:
  HapticUsb() {
    // Moves to its zero and back ten times a second, so that homing is fast.
    model().grip = [this, slow = model().grip](double t_s) { return slow(model().homed() ? t_s : 10 * t_s); };
    model().powerOn();
    usb_ = test::plugIn(model(), GetParam().id);
  }
  void SetUp() override {
    if (usb_ == nullptr) GTEST_SKIP() << test::kNoPlug;
  }
  HapticModel& model() { return *bench_.model; }
  bool pushes() {
    const std::lock_guard guard(usb_->lock());
    return model().pushes(clock_.now());
  }
  std::unique_ptr<HapticDevice> run() {
    auto device = bench_.driver_on_libusb(clock_);
    const auto opened = device->open();
    EXPECT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(device->home() && device->start());
    return device;
  }
  void push(HapticDevice& device, int ticks, double force_n = 2) {
    MonotonicTime next = clock_.now();
    for (int i = 0; i < ticks; ++i) {
      ASSERT_TRUE(device.read() && device.write({0, 0, force_n}));
      next += kTick;
      clock_.sleepUntil(next);
    }
  }

  // Writes forces until the device pushes. When a busy machine stalls, the driver stops pushing and fades in again.
  void pushUntilFelt(HapticDevice& device) {
    for (int i = 0; i < 100 && !pushes(); ++i) push(device, 50);
    EXPECT_TRUE(pushes());
  }

  test::UsbBench bench_ = GetParam().make();
  std::unique_ptr<test::PluggedUsb> usb_;
  MonotonicClock clock_;
};
INSTANTIATE_TEST_SUITE_P(Kinds, HapticUsb, testing::ValuesIn(test::usbKinds().begin(), test::usbKinds().end()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(HapticUsb, ExchangesACommandForEveryTick) {
  constexpr int kTicks = 1000;
  const auto device = run();
  const int before = model().commands();
  push(*device, kTicks);
  const auto sample = device->read();
  ASSERT_TRUE(sample);
  EXPECT_LT(glm::distance(sample->position_mm, GetParam().rest_mm), 0.1);
  const auto off_n = [&] {
    const std::lock_guard guard(usb_->lock());
    return glm::distance(model().forceAt(GetParam().rest_mm, clock_.now()), {0, 0, 2});
  };
  const MonotonicTime patience = clock_.now() + std::chrono::seconds(60);  // see pushUntilFelt: it fades in again
  while (off_n() > 0.02 && clock_.now() < patience) push(*device, 1);
  EXPECT_LT(off_n(), 0.02);
  device->stop();
  EXPECT_FALSE(pushes());
  // A guest's time is virtual; a mocked machine may be busy.
  if (!test::machineIsMocked()) {
    EXPECT_GT(model().commands() - before, 950) << "of a thousand";
  }
  EXPECT_EQ(usb_->unknownRequests(), 0);
}

// Unplugged at the first request, the second, the third, the fifth and so on until it runs, and then while it runs.
TEST_P(HapticUsb, UnpluggedAtAnyRequestItIsLostAndComesBack) {
  const auto begin = [](HapticDevice& device) -> Result<void> {
    if (auto opened = device.open(); !opened) return opened;
    if (auto homed = device.home(); !homed) return homed;
    return device.start();
  };
  const auto device = bench_.driver_on_libusb(clock_);
  (void)device->open();  // makes libusb open what it keeps open forever
  device->close();
  const std::ptrdiff_t descriptors = openDescriptors();
  const auto replug = [&] {
    usb_->unplug();
    device->close();
    EXPECT_EQ(device->open().error().code, ErrorCode::NotFound);
    model().powerOn();
    usb_->plug();
  };
  int moment = 1;
  for (int next = 2; true; std::swap(moment, next), next += moment) {
    usb_->unplugAfter(moment);
    if (begin(*device)) break;
    EXPECT_NE(device->state(), State::Running) << moment;
    replug();
  }
  EXPECT_GT(moment, 100) << "and then it works";
  usb_->unplugAfter(0);
  for (const int later : {1, 2, 20}) {
    push(*device, 10);
    usb_->unplugAfter(later);
    int ticks = 0;
    for (; device->state() == State::Running && ticks < 100; ++ticks) {
      (void)device->read();
      (void)device->write({0, 0, 2});
      clock_.sleepUntil(clock_.now() + kTick);
    }
    EXPECT_EQ(device->state(), State::Lost) << later;
    replug();
    ASSERT_TRUE(begin(*device)) << later;
  }
  device->close();
  // The transport closes its own descriptors a little later.
  for (int i = 0; i < 100 && openDescriptors() > descriptors; ++i) clock_.sleepUntil(clock_.now() + 10 * kTick);
  EXPECT_LE(openDescriptors(), descriptors);
}

TEST_P(HapticUsb, TheWatchdogStopsTheMotorsOfATaskThatHangs) {
  const auto device = run();
  pushUntilFelt(*device);
  const MonotonicTime hangs = clock_.now();  // no read, no write
  while (pushes() && clock_.now() - hangs < std::chrono::seconds(5)) clock_.sleepUntil(clock_.now() + kTick);
  EXPECT_FALSE(pushes());
  if (!test::machineIsMocked()) {
    EXPECT_LT(clock_.now() - hangs, std::chrono::milliseconds(30));
  }
}

TEST_P(HapticUsb, ASecondFingerOnItIsRefusedAndTheFirstFeelsOn) {
  if (test::machineIsMocked()) GTEST_SKIP() << "a mocked kernel lets everyone claim an interface";
  const auto first = run(), second = bench_.driver_on_libusb(clock_);
  const auto opened = second->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
  EXPECT_NE(std::string(opened.error().message).find("already a finger"), std::string::npos) << opened.error().message;
  pushUntilFelt(*first);
}

TEST_P(HapticUsb, AFatalSignalsHandlerStopsTheMotorsWhateverOtherThreadsDo) {
  const auto device = run();
  pushUntilFelt(*device);
  quietenAllUsbDevices();
  EXPECT_FALSE(pushes());
  // The task runs on until the process ends. A device that gets no command may not answer, and is then lost.
  for (int i = 0; i < 20; ++i) {
    (void)device->read();
    (void)device->write({0, 0, 2});
    clock_.sleepUntil(clock_.now() + kTick);
  }
  EXPECT_FALSE(pushes());
  if (device->state() == State::Running) device->stop();
  else device->close();
  const int commands = model().commands();
  quietenAllUsbDevices();
  EXPECT_EQ(model().commands(), commands) << "no device is listed any more";
}

TEST_P(HapticUsb, ACommandThatTheDeviceDidNotTakeIsTakenBackBeforeTheMotorsAreStopped) {
  const auto device = run();
  pushUntilFelt(*device);
  usb_->takesNothing();
  push(*device, 2, 4);
  clock_.sleepUntil(clock_.now() +
                    std::chrono::milliseconds(100));  // the watchdog acts, but the device does not take the command
  const int before = model().pushingCommands();
  usb_->takesAgain();
  clock_.sleepUntil(clock_.now() + std::chrono::milliseconds(100));
  EXPECT_EQ(model().pushingCommands(), before);
  EXPECT_FALSE(pushes()) << "the watchdog tries again";
}

// Sends a number in every packet, one per millisecond.
class Counter final : public test::UsbModel {
 public:
  void control(std::uint8_t, std::uint16_t, MonotonicTime) override {}
  void write(UsbBytes, MonotonicTime) override {}
  std::optional<UsbPacket> read(MonotonicTime now) override {
    if (now - last_ < kTick) return std::nullopt;
    last_ = now;
    UsbPacket packet;
    packet.bytes = 2;
    packet.data = {static_cast<std::uint8_t>(count_ & 0xFF), static_cast<std::uint8_t>(count_ >> 8)};
    ++count_;
    return packet;
  }

 private:
  MonotonicTime last_;
  int count_ = 0;
};

TEST(LibusbPort, TakesEveryPacketInItsOrder) {
  Counter counter;
  const auto usb = test::plugIn(counter, falcon::kUsbId);
  if (usb == nullptr) GTEST_SKIP() << test::kNoPlug;
  MonotonicClock clock;
  const auto port = makeLibusbPort({falcon::kUsbId});
  ASSERT_TRUE(port->open() && port->startExchange({}));
  int next = 0;
  for (int i = 0; i < 20'000 && next < 200; ++i) {
    const auto packet = port->take();
    ASSERT_TRUE(packet);
    if (packet->bytes == 0) clock.sleepUntil(clock.now() + kTick / 4);
    else ASSERT_EQ(packet->data[0] | packet->data[1] << 8, next++);
  }
  EXPECT_EQ(next, 200);
}

TEST(FalconUsb, LoadsItsFirmwareAlsoWhenTheFirstTryFailsInEachWayThatUsersReport) {
  const FalconFaults ways[] = {
      {.silent_loads = 1}, {.wrong_echo_loads = 1}, {.dead_loads = 1}, {.leading_zero = true}, {.most_payload = 3}};
  const test::FirmwareFile firmware(200);
  MonotonicClock clock;
  for (const FalconFaults& faults : ways) {
    FalconModel model(firmware.image(), faults);
    const auto usb = test::plugIn(model, falcon::kUsbId);
    if (usb == nullptr) GTEST_SKIP() << test::kNoPlug;
    const auto device = makeFalcon({.firmware_path = firmware.path()}, clock);
    const auto opened = device->open();
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(model.running());
    EXPECT_EQ(usb->unknownRequests(), 0);
  }
}

}  // namespace
}  // namespace relievo
