// SPDX-License-Identifier: Apache-2.0
// What is told of input nodes that may not be opened; umockdev simulates them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "drivers/gamepad/gamepad.h"
#include "tests/support/device/mocked_machine.h"

namespace relievo {
namespace {

using testing::StartsWith;

class GamepadEvdev : public test::MockedMachine {
 protected:
  // To a user who may not open /dev/input/event1, the keys of which are as sysfs lists them.
  std::string toldOf(const std::string& keys) {
    const std::unique_ptr<char, decltype(&g_free)> root(umockdev_testbed_get_root_dir(bed_), g_free);
    const std::string place = root.get(), node = place + "/dev/input/event1";
    const std::string listed = place + "/sys/class/input/event1/device/capabilities";
    for (const std::string& folder : {place + "/dev/input", listed}) std::filesystem::create_directories(folder);
    std::ofstream(node).close();
    std::ofstream(listed + "/key") << keys << "\n";
    EXPECT_EQ(::chmod(node.c_str(), 0) | ::chmod(root.get(), 0755), 0);
    for (const char* socket : {"/ioctl", "/ioctl/_default"}) ::chmod((place + socket).c_str(), 0777);  // the test bed's
    constexpr uid_t kNobody = 65534;
    const uid_t user = ::geteuid();
    EXPECT_EQ(::seteuid(user == 0 ? kNobody : user), 0);  // root may open everything
    std::string told = lookAtGamepads().front().state;
    EXPECT_EQ(::seteuid(user), 0);
    return told;
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
