// SPDX-License-Identifier: Apache-2.0
// The contract of every haptic device: states, and no force unless one is requested. List the back ends in a test of
// your own: INSTANTIATE_TEST_SUITE_P(Backends, HapticDeviceContract, testing::Values(..), test::kBackendName).
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <ostream>
#include <vector>

#include "hal/haptic_device.h"
#include "platform/clock.h"
#include "tests/contract/suite/backend_name.h"

namespace relievo {
namespace test {

// A device under test, a way to observe whether it pushes, and the number of the test's own allocations.
struct HapticRig {
  std::shared_ptr<void> bench;
  std::unique_ptr<HapticDevice> device;
  std::function<bool()> pushes;
  std::function<std::uint64_t()> allocations = [] { return std::uint64_t{0}; };
  int ticks_to_push = 1;  // until the force has faded in
};

struct HapticBackend {
  const char* name;
  std::function<HapticRig(ManualClock&)> make;
  std::function<HapticRig(ManualClock&)> make_losing;  // Lost at the first read; null if it cannot be lost
  bool has_motors = true;                              // false: no force is ever observed
};
inline void PrintTo(const HapticBackend& backend, std::ostream* out) {
  *out << backend.name;
}

// Of a static library the linker takes only what is referenced. This reference brings the suite's cases into every
// program that includes this header.
[[nodiscard]] bool hapticDeviceCases();
inline const bool kHapticDeviceCases = hapticDeviceCases();

}  // namespace test

class HapticDeviceContract : public testing::TestWithParam<test::HapticBackend> {
 protected:
  using State = HapticDevice::State;

  // Returns a device in that state, or none if this back end cannot reach it.
  test::HapticRig bring(State state);
  // Running, and pushing 1 N to the right.
  test::HapticRig pushing();

  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  std::vector<std::shared_ptr<void>> benches_;  // must outlive the returned devices
};

}  // namespace relievo
