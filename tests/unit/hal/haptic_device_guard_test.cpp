// SPDX-License-Identifier: Apache-2.0
// What the state guard of a haptic device does by itself, on a device that never fails.
#include <gtest/gtest.h>

#include "tests/support/device/fake_haptic_device.h"

namespace relievo {
namespace {

using State = HapticDevice::State;

ErrorCode codeOf(const Result<void>& result) {
  return result ? ErrorCode{} : result.error().code;
}

TEST(HapticDeviceGuard, ACancelledOpeningStaysCancelledUntilTheDeviceIsClosed) {
  test::FakeHapticDevice device;
  device.cancel();
  EXPECT_EQ(codeOf(device.open()), ErrorCode::Cancelled);
  EXPECT_EQ(codeOf(device.open()), ErrorCode::Cancelled);
  EXPECT_EQ(device.state(), State::Closed);
  device.close();
  EXPECT_TRUE(device.open());
}

TEST(HapticDeviceGuard, ACancelledHomingLeavesTheDeviceOpened) {
  test::FakeHapticDevice device;
  ASSERT_TRUE(device.open());
  device.cancel();
  EXPECT_EQ(codeOf(device.home()), ErrorCode::Cancelled);
  EXPECT_EQ(device.state(), State::Opened);
  EXPECT_EQ(codeOf(device.start()), ErrorCode::InvalidState);
  device.close();
  EXPECT_TRUE(device.open() && device.home() && device.start());
}

}  // namespace
}  // namespace relievo
