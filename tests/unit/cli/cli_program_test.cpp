// SPDX-License-Identifier: Apache-2.0
// The last actions of a program, however it ends.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "app/cli/program.h"

namespace relievo {
namespace {

void quieten() noexcept {
  static_cast<void>(::write(STDERR_FILENO, "quiet", 5));
}

void begin() {
  static_cast<void>(stopOnSignals(quieten));
}

TEST(ProgramDeathTest, ALibraryThatEndsTheProgramDoesNotLeaveTheMotorsOn) {
  EXPECT_EXIT((begin(), std::exit(3)), testing::ExitedWithCode(3), "^quiet$");
}

TEST(ProgramDeathTest, NeitherDoesASecondSignal) {
  EXPECT_EXIT((begin(), std::raise(SIGTERM), std::raise(SIGTERM), ::pause()), testing::KilledBySignal(SIGTERM),
              "^quiet$");
}

}  // namespace
}  // namespace relievo
