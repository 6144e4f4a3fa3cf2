// SPDX-License-Identifier: Apache-2.0
// A kernel that refuses a transfer, which umockdev alone can simulate.
#include <gtest/gtest.h>

#include "drivers/falcon/link.h"
#include "drivers/usb/usb_port.h"
#include "tests/support/device/usb/umockdev_usb.h"

namespace relievo {
namespace {

class SilentModel final : public test::UsbModel {
 public:
  void control(std::uint8_t, std::uint16_t, MonotonicTime) override {}
  void write(UsbBytes, MonotonicTime) override {}
  std::optional<UsbPacket> read(MonotonicTime) override { return std::nullopt; }
};

TEST(LibusbPort, AfterAFailedStartTheKernelHasNothingOfIt) {
  if (!test::machineIsMocked()) GTEST_SKIP() << test::kNoPlug;
  SilentModel silent;
  test::UmockdevUsb usb(silent, falcon::kUsbId);
  const auto port = makeLibusbPort({falcon::kUsbId});
  ASSERT_TRUE(port->open());
  usb.refuseSubmit(2);
  EXPECT_FALSE(port->startExchange({}));
  EXPECT_EQ(usb.waiting(), 0u);
}

}  // namespace
}  // namespace relievo
