// SPDX-License-Identifier: Apache-2.0
// A test fixture for devices that umockdev simulates. Only under `umockdev-wrapper`.
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <umockdev.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace relievo::test {

class MockedMachine : public testing::Test {
 protected:
  void SetUp() override {
    bed_ = umockdev_testbed_new();
    if (!umockdev_in_mock_environment()) GTEST_SKIP() << "run it under umockdev-wrapper";
  }
  void TearDown() override {
    if (bed_ != nullptr) g_object_unref(bed_);
  }

  // What `ask` says to a user who may not open /dev/input/event1. `listed`: the codes of that device by their kind, as
  // sysfs lists them.
  std::string toldOfAClosedNode(const std::map<std::string, std::string>& listed,
                                const std::function<std::string()>& ask) {
    const std::unique_ptr<char, decltype(&g_free)> root(umockdev_testbed_get_root_dir(bed_), g_free);
    const std::string place = root.get(), node = place + "/dev/input/event1";
    const std::string codes = place + "/sys/class/input/event1/device/capabilities";
    for (const std::string& folder : {place + "/dev/input", codes}) std::filesystem::create_directories(folder);
    std::ofstream(node).close();
    for (const auto& [kind, words] : listed) std::ofstream(codes + "/" + kind) << words << "\n";
    EXPECT_EQ(::chmod(node.c_str(), 0) | ::chmod(root.get(), 0755), 0);
    for (const char* socket : {"/ioctl", "/ioctl/_default"}) ::chmod((place + socket).c_str(), 0777);  // the test bed's
    constexpr uid_t kNobody = 65534;
    const uid_t user = ::geteuid();
    EXPECT_EQ(::seteuid(user == 0 ? kNobody : user), 0);  // root may open everything
    std::string told = ask();
    EXPECT_EQ(::seteuid(user), 0);
    return told;
  }

  UMockdevTestbed* bed_ = nullptr;
};

}  // namespace relievo::test
