// SPDX-License-Identifier: Apache-2.0
// A test fixture for devices that umockdev simulates. Only under `umockdev-wrapper`.
#pragma once

#include <gtest/gtest.h>
#include <umockdev.h>

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

  UMockdevTestbed* bed_ = nullptr;
};

}  // namespace relievo::test
