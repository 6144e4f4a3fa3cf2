// SPDX-License-Identifier: Apache-2.0
// The contract of every display: states, the promised surface, and no wait longer than its refresh. List the back ends
// in a test of your own: INSTANTIATE_TEST_SUITE_P(Backends, DisplayContract, testing::Values(..), test::kBackendName).
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>

#include "hal/display.h"
#include "platform/clock.h"
#include "tests/contract/suite/backend_name.h"

namespace relievo {
namespace test {

// One whose `open` returns Unsupported is skipped.
struct DisplayBackend {
  const char* name;
  std::function<std::unique_ptr<Display>(ManualClock&)> make;
  bool any_size = true;            // false: the actual size may differ from the requested one
  bool any_number = true;          // false: only one can be open
  const char* not_here = nullptr;  // why it cannot be tested on this machine; null: it can
};
inline void PrintTo(const DisplayBackend& backend, std::ostream* out) {
  *out << backend.name;
}

// Of a static library the linker takes only what is referenced. This reference brings the suite's cases into every
// program that includes this header.
[[nodiscard]] bool displayCases();
inline const bool kDisplayCases = displayCases();

}  // namespace test

class DisplayContract : public testing::TestWithParam<test::DisplayBackend> {
 protected:
  using State = Display::State;

  void SetUp() override;
  std::unique_ptr<Display> bring(State state);

  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
};

}  // namespace relievo
