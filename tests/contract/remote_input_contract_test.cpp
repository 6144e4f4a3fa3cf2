// SPDX-License-Identifier: Apache-2.0
// What every remote control keeps to.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "drivers/mock/scripted_remote.h"
#include "drivers/window/window_remote.h"
#include "tests/contract/state_table.h"

namespace relievo {
namespace {

using State = RemoteInput::State;
using namespace std::chrono_literals;

struct Remote {
  std::unique_ptr<RemoteInput> input;
  std::function<void()> press;  // KEY_OK, one second after opening; called then
};

struct Backend {
  const char* name;
  std::function<Remote(ManualClock&)> make;
};
void PrintTo(const Backend& backend, std::ostream* out) {
  *out << backend.name;
}

const Backend kBackends[] = {
    {"script", [](ManualClock& clock) { return Remote{makeScriptedRemote({{1s, KEY_OK}}, clock), [] {}}; }},
    {"window",
     [](ManualClock& clock) {
       const auto window = std::make_shared<WindowInput>();
       return Remote{makeWindowRemote(window),
                     [window, &clock] { EXPECT_TRUE(window->keys.tryPush({.code = KEY_OK, .time = clock.now()})); }};
     }},
};

class RemoteInputContract : public testing::TestWithParam<Backend> {
 protected:
  ManualClock clock_{MonotonicTime(1h)};
};
INSTANTIATE_TEST_SUITE_P(Backends, RemoteInputContract, testing::ValuesIn(kBackends),
                         [](const auto& test) { return std::string(test.param.name); });

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
  test::expectStateTable(verbs, table, [&](State state) {
    auto remote = GetParam().make(clock_).input;
    EXPECT_TRUE(state != State::Open || remote->open());
    return remote;
  });
}

TEST_P(RemoteInputContract, YieldsAKeyOnceAndNothingInBetween) {
  const auto [remote, press] = GetParam().make(clock_);
  for (int opening = 0; opening < 2; ++opening) {
    ASSERT_TRUE(remote->open());
    EXPECT_FALSE(remote->poll(clock_.now()).value()) << "no key yet";
    clock_.advance(1s);
    press();
    clock_.advance(1s);
    const auto key = remote->poll(clock_.now()).value();
    ASSERT_TRUE(key);
    EXPECT_EQ(key->code, KEY_OK);
    EXPECT_LE(key->time, clock_.now());
    EXPECT_FALSE(remote->poll(clock_.now()).value());
    remote->close();
  }
}

TEST(WindowRemote, WhatWasPressedBeforeItListenedIsNotMeantForIt) {
  const auto window = std::make_shared<WindowInput>();
  const auto remote = makeWindowRemote(window);
  for (std::uint16_t key = 0; key < WindowInput::kMostKeys; ++key) ASSERT_TRUE(window->keys.tryPush({.code = KEY_OK}));
  EXPECT_FALSE(window->keys.tryPush({.code = KEY_OK})) << "full: nobody listens";
  ASSERT_TRUE(remote->open());
  EXPECT_FALSE(remote->poll({}).value());
  ASSERT_TRUE(window->keys.tryPush({.code = KEY_UP, .action = KeyEvent::Action::Release}));
  const auto key = remote->poll({}).value();
  ASSERT_TRUE(key);
  EXPECT_EQ(key->code, KEY_UP);
  EXPECT_EQ(key->action, KeyEvent::Action::Release);
}

}  // namespace
}  // namespace relievo
