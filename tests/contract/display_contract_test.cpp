// SPDX-License-Identifier: Apache-2.0
// The contract of every display: states, the promised surface, and no wait longer than its refresh.
#include <gtest/gtest.h>

#include <cstdlib>

#include "drivers/egl/egl.h"
#include "drivers/mock/mock.h"
#include "drivers/sample/sample.h"
#include "tests/contract/state_table.h"
#include "tests/support/machine/guest_screen.h"
#include "tests/support/machine/x_screen.h"

namespace relievo {
namespace {

using State = Display::State;
using namespace std::chrono_literals;

struct Backend {
  const char* name;
  std::function<std::unique_ptr<Display>(ManualClock&)> make;
  bool any_size = true;    // false: the actual size may differ from the requested one
  bool any_number = true;  // false: only one can be open
};
void PrintTo(const Backend& backend, std::ostream* out) {
  *out << backend.name;
}

// On an X server of its own if Xvfb is installed; else `open` returns Unsupported.
std::unique_ptr<Display> makeWindow(ManualClock& clock) {
  static const auto screen = test::XScreen::start();
  return makeWindowDisplay(std::make_shared<WindowInput>(), clock);
}

const Backend kBackends[] = {
    {"mock", [](ManualClock& clock) { return makeMockDisplay({}, clock); }},
    {"offscreen", [](ManualClock& clock) { return makeOffscreenDisplay({}, clock); }},
    {"window", makeWindow},
    {"sample", [](ManualClock&) { return makeSampleDisplay(); }},
    {"kms", [](ManualClock&) { return makeKmsDisplay(); }, false, false},
};

class DisplayContract : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (!GetParam().any_number && std::getenv("RELIEVO_SCREENS") == nullptr) GTEST_SKIP() << test::kNoGuest;
    const auto opened = GetParam().make(clock_)->open({64, 48});
    if (!opened && opened.error().code == ErrorCode::Unsupported) GTEST_SKIP() << opened.error().message;
  }
  std::unique_ptr<Display> bring(State state) {
    auto display = GetParam().make(clock_);
    if (state == State::Closed) return display;
    EXPECT_TRUE(display->open({64, 48}));
    EXPECT_TRUE(state != State::Drawing || display->beginFrame());
    return display;
  }
  ManualClock clock_{MonotonicTime(1h)};
};
INSTANTIATE_TEST_SUITE_P(Backends, DisplayContract, testing::ValuesIn(kBackends),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(DisplayContract, EveryVerbInEveryState) {
  const std::vector<test::Verb<Display>> verbs = {
      {"open", [](Display& d) { return test::answerOf(d.open({64, 48})); }},
      {"beginFrame", [](Display& d) { return test::answerOf(d.beginFrame()); }},
      {"present", [](Display& d) { return test::answerOf(d.present()); }},
      {"attend", [](Display& d) { return test::answerOf(d.attend()); }},
      {"close", [](Display& d) { return d.close(), test::Answer{}; }},
  };
  constexpr auto no = std::nullopt;
  const std::vector<test::Row<State>> table = {
      // from            open         beginFrame      present      attend       close
      {State::Closed, {State::Open, no, no, no, State::Closed}},
      {State::Open, {no, State::Drawing, no, State::Open, State::Closed}},
      {State::Drawing, {no, no, State::Open, no, State::Closed}},
  };
  test::expectStateTable(verbs, table, [&](State state) { return bring(state); });
}

TEST_P(DisplayContract, CapabilitiesAreTheSameInEveryState) {
  for (const State state : {State::Closed, State::Open, State::Drawing}) {
    const auto display = bring(State::Closed);
    const DisplayCapabilities closed = display->capabilities();
    ASSERT_TRUE(display->open({64, 48}));
    const DisplayCapabilities open = display->capabilities();
    if (state != State::Open) {
      ASSERT_TRUE(display->beginFrame());
    }
    if (state == State::Closed) display->close();
    ASSERT_EQ(display->state(), state);
    const DisplayCapabilities now = display->capabilities();
    EXPECT_STREQ(now.name, closed.name);
    EXPECT_EQ(now.gles, closed.gles);
    EXPECT_EQ(now.refresh_period, open.refresh_period) << "known from the first opening on";
  }
}

TEST_P(DisplayContract, GivesASurfaceOfASizeThatStays) {
  const auto display = bring(State::Open);
  DisplaySurface first;
  for (int i = 0; i < 3; ++i) {
    const auto surface = display->beginFrame();
    ASSERT_TRUE(surface);
    if (i == 0) first = *surface;
    EXPECT_TRUE(!GetParam().any_size || (surface->width == 64 && surface->height == 48));
    EXPECT_EQ(surface->width, first.width);
    EXPECT_EQ(surface->height, first.height);
    EXPECT_GT(surface->width * surface->height, 0);
    EXPECT_TRUE(display->capabilities().gles || surface->framebuffer == 0);
    ASSERT_TRUE(display->present());
  }
}

TEST_P(DisplayContract, PresentTakesNoLongerThanARefresh) {
  const auto display = bring(State::Open);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(display->beginFrame());
    const auto shown = display->present();
    ASSERT_TRUE(shown);
    EXPECT_GE(*shown, Duration(0));
    EXPECT_LE(*shown, display->capabilities().refresh_period);
    clock_.advance(7ms);
  }
}

TEST_P(DisplayContract, RefusesASizeThatIsNone) {
  const auto display = bring(State::Closed);
  for (const DisplayConfig& config : {DisplayConfig{0, 48}, DisplayConfig{64, -1}, DisplayConfig{64, 16385}}) {
    const auto opened = display->open(config);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::InvalidArgument);
    EXPECT_EQ(display->state(), State::Closed);
  }
  EXPECT_TRUE(display->open({64, 48})) << "and works again as before";
}

TEST_P(DisplayContract, OpensAgainInAnotherSize) {
  const auto display = bring(State::Drawing);
  display->close();
  ASSERT_TRUE(display->open({32, 16}));
  const auto surface = display->beginFrame();
  ASSERT_TRUE(surface);
  EXPECT_TRUE(!GetParam().any_size || (surface->width == 32 && surface->height == 16));
}

TEST_P(DisplayContract, TwoAtOnceDoNotDisturbEachOther) {
  if (!GetParam().any_number) GTEST_SKIP() << "there is one screen";
  const auto one = bring(State::Open);
  const auto other = bring(State::Open);
  ASSERT_TRUE(one->beginFrame());
  ASSERT_TRUE(other->beginFrame());
  EXPECT_TRUE(one->present());
  other->close();
  EXPECT_TRUE(one->beginFrame());
  EXPECT_TRUE(one->present());
}

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
  EXPECT_EQ(display->state(), State::Closed);
}

}  // namespace
}  // namespace relievo
