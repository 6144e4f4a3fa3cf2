// SPDX-License-Identifier: Apache-2.0
// What is told of input nodes that may not be opened; umockdev simulates them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "drivers/gamepad/gamepad.h"
#include "tests/support/device/mocked_machine.h"

namespace relievo {
namespace {

using testing::StartsWith;

class GamepadEvdev : public test::MockedMachine {
 protected:
  std::string toldOf(const std::string& keys) {
    return toldOfAClosedNode({{"key", keys}}, [] { return lookAtGamepads().front().state; });
  }
};

TEST_F(GamepadEvdev, AKeyboardThatMayNotBeOpenedIsNoGamepad) {
  if (sizeof(long) != 8) GTEST_SKIP() << "words of 32 bits";
  EXPECT_THAT(toldOf("10000 402000000 3803078f800d001 feffffdfffefffff fffffffffffffffe"), StartsWith("no gamepad"));
}

TEST_F(GamepadEvdev, APadThatMayNotBeOpenedIsTold) {
  if (sizeof(long) != 8) GTEST_SKIP() << "words of 32 bits";
  EXPECT_THAT(toldOf("7cdb000000000000 0 0 0 0"), StartsWith("no permission to use the gamepad"));
}

}  // namespace
}  // namespace relievo
