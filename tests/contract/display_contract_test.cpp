// SPDX-License-Identifier: Apache-2.0
// Every display under the contract; tests that need the fault switches of a mock.
#include <gtest/gtest.h>

#include <cstdlib>

#include "drivers/egl/egl.h"
#include "drivers/mock/mock.h"
#include "drivers/sample/sample.h"
#include "tests/contract/suite/display.h"
#include "tests/support/machine/guest_screen.h"
#include "tests/support/machine/x_screen.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

// On an X server of its own if Xvfb is installed; else `open` returns Unsupported.
std::unique_ptr<Display> makeWindow(ManualClock& clock) {
  static const auto screen = test::XScreen::start();
  return makeWindowDisplay(std::make_shared<WindowInput>(), clock);
}

const test::DisplayBackend kBackends[] = {
    {"mock", [](ManualClock& clock) { return makeMockDisplay({}, clock); }},
    {"offscreen", [](ManualClock& clock) { return makeOffscreenDisplay({}, clock); }},
    {"window", makeWindow},
    {"sample", [](ManualClock&) { return makeSampleDisplay(); }},
    {"kms", [](ManualClock&) { return makeKmsDisplay(); }, false, false,
     std::getenv("RELIEVO_SCREENS") == nullptr ? test::kNoGuest : nullptr},
};

INSTANTIATE_TEST_SUITE_P(Backends, DisplayContract, testing::ValuesIn(kBackends), test::kBackendName);

// ---- tests that need the fault switches of a mock
// -----------------------------------------------------------------

TEST(MockDisplay, ShowsAtItsRefreshes) {
  ManualClock clock(MonotonicTime(1h));
  const auto display = makeMockDisplay({.refresh_period = 20ms}, clock);
  ASSERT_TRUE(display->open({64, 48}));
  // Opened on a refresh; then presents 5 ms later, on the refresh itself, and 30 ms late.
  const struct {
    Duration wait, shown;
  } frames[] = {{5ms, 15ms}, {0ms, 20ms}, {30ms, 10ms}};
  for (const auto& frame : frames) {
    clock.advance(frame.wait);
    ASSERT_TRUE(display->beginFrame());
    EXPECT_EQ(display->present().value(), frame.shown);
  }
  EXPECT_EQ(clock.now(), MonotonicTime(1h + 80ms));
}

TEST(MockDisplay, WithoutARefreshShowsAtOnce) {
  ManualClock clock;
  const auto display = makeMockDisplay({.refresh_period = 0ns}, clock);
  ASSERT_TRUE(display->open({64, 48}));
  ASSERT_TRUE(display->beginFrame());
  EXPECT_EQ(display->present().value(), Duration(0));
  EXPECT_EQ(clock.now(), MonotonicTime{});
}

TEST(MockDisplay, ALostScreenStaysLostUntilClosedAndOpened) {
  ManualClock clock;
  const auto display = makeMockDisplay({.lose_after_frames = 1}, clock);
  ASSERT_TRUE(display->open({64, 48}));
  ASSERT_TRUE(display->beginFrame() && display->present());
  EXPECT_EQ(display->beginFrame().error().code, ErrorCode::Lost);
  EXPECT_EQ(display->beginFrame().error().code, ErrorCode::Lost);
  display->close();
  ASSERT_TRUE(display->open({64, 48}));
  EXPECT_TRUE(display->beginFrame());
}

TEST(MockDisplay, AFailedOpeningLeavesItClosed) {
  ManualClock clock;
  const auto display = makeMockDisplay({.fail_open = ErrorCode::Unsupported}, clock);
  EXPECT_EQ(display->open({64, 48}).error().code, ErrorCode::Unsupported);
  EXPECT_EQ(display->state(), Display::State::Closed);
}

}  // namespace
}  // namespace relievo
