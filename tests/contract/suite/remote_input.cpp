// SPDX-License-Identifier: Apache-2.0
// The cases of the remote control's contract.
#include "tests/contract/suite/remote_input.h"

#include <utility>
#include <vector>

#include "tests/contract/state_table.h"

namespace relievo {

using namespace std::chrono_literals;

bool test::remoteInputCases() {
  return true;
}
// Without this line a program fails that the linker gives this file only for an inline function of the standard
// library.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RemoteInputContract);

TEST_P(RemoteInputContract, EveryVerbInEveryState) {
  const std::vector<test::Verb<RemoteInput>> verbs = {
      {"open", [](RemoteInput& r) { return test::answerOf(r.open()); }},
      {"poll", [](RemoteInput& r) { return test::answerOf(r.poll(MonotonicTime(1h))); }},
      {"close", [](RemoteInput& r) { return r.close(), test::Answer{}; }},
  };
  constexpr auto no = std::nullopt;
  const std::vector<test::Row<State>> table = {
      // from           open      poll       close
      {State::Closed, {State::Open, no, State::Closed}},
      {State::Open, {no, State::Open, State::Closed}},
  };
  std::vector<std::function<void()>> senders;  // a sender keeps its pseudo-terminal open
  test::expectStateTable(verbs, table, [&](State state) {
    auto [remote, press, key] = GetParam().make(clock_);
    senders.push_back(std::move(press));
    EXPECT_TRUE(state != State::Open || remote->open());
    return std::move(remote);
  });
}

TEST_P(RemoteInputContract, YieldsAKeyOnceAndNothingInBetween) {
  const auto [remote, press, expected] = GetParam().make(clock_);
  for (int opening = 0; opening < 2; ++opening) {
    ASSERT_TRUE(remote->open());
    EXPECT_FALSE(remote->poll(clock_.now()).value()) << "no key yet";
    clock_.advance(1s);
    press();
    clock_.advance(1s);
    const auto key = remote->poll(clock_.now()).value();
    ASSERT_TRUE(key);
    EXPECT_EQ(key->code, expected);
    EXPECT_EQ(key->action, KeyEvent::Action::Press);
    EXPECT_LE(key->time, clock_.now());
    while (const auto next = remote->poll(clock_.now()).value()) {
      EXPECT_EQ(next->code, expected);
      EXPECT_EQ(next->action, KeyEvent::Action::Release);
    }
    remote->close();
  }
}

}  // namespace relievo
