// SPDX-License-Identifier: Apache-2.0
// The cases of the display's contract.
#include "tests/contract/suite/display.h"

#include <vector>

#include "tests/contract/state_table.h"

namespace relievo {

using namespace std::chrono_literals;

bool test::displayCases() {
  return true;
}
// Without this line a program fails that the linker gives this file only for an inline function of the standard
// library.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(DisplayContract);

void DisplayContract::SetUp() {
  if (GetParam().not_here != nullptr) GTEST_SKIP() << GetParam().not_here;
  const auto opened = GetParam().make(clock_)->open({64, 48});
  if (!opened && opened.error().code == ErrorCode::Unsupported) GTEST_SKIP() << opened.error().message;
}

std::unique_ptr<Display> DisplayContract::bring(State state) {
  auto display = GetParam().make(clock_);
  if (state == State::Closed) return display;
  EXPECT_TRUE(display->open({64, 48}));
  EXPECT_TRUE(state != State::Drawing || display->beginFrame());
  return display;
}

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

}  // namespace relievo
