// SPDX-License-Identifier: Apache-2.0
// The contract of every remote control. List the back ends in a test of your own:
// INSTANTIATE_TEST_SUITE_P(Backends, RemoteInputContract, testing::Values(..), test::kBackendName).
#pragma once

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <ostream>

#include "hal/remote_input.h"
#include "platform/clock.h"
#include "tests/contract/suite/backend_name.h"

namespace relievo {
namespace test {

struct RemoteRig {
  std::unique_ptr<RemoteInput> input;
  std::function<void()> press;  // called one second after opening
  std::uint16_t key = KEY_OK;
};

struct RemoteBackend {
  const char* name;
  std::function<RemoteRig(ManualClock&)> make;
};
inline void PrintTo(const RemoteBackend& backend, std::ostream* out) {
  *out << backend.name;
}

// Of a static library the linker takes only what is referenced. This reference brings the suite's cases into every
// program that includes this header.
[[nodiscard]] bool remoteInputCases();
inline const bool kRemoteInputCases = remoteInputCases();

}  // namespace test

class RemoteInputContract : public testing::TestWithParam<test::RemoteBackend> {
 protected:
  using State = RemoteInput::State;

  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
};

}  // namespace relievo
