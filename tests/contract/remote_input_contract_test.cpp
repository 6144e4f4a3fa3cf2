// SPDX-License-Identifier: Apache-2.0
// What every remote control keeps to.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "drivers/mock/scripted_remote.h"
#include "tests/contract/state_table.h"

namespace relievo {
namespace {

using State = RemoteInput::State;
using namespace std::chrono_literals;

struct Backend {
  const char* name;
  // A remote on which KEY_OK is pressed one second after opening.
  std::function<std::unique_ptr<RemoteInput>(ManualClock&)> make;
};
void PrintTo(const Backend& backend, std::ostream* out) {
  *out << backend.name;
}

const Backend kBackends[] = {
    {"script", [](ManualClock& clock) { return makeScriptedRemote({{1s, KEY_OK}}, clock); }},
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
    auto remote = GetParam().make(clock_);
    EXPECT_TRUE(state != State::Open || remote->open());
    return remote;
  });
}

TEST_P(RemoteInputContract, YieldsAKeyOnceAndNothingInBetween) {
  const auto remote = GetParam().make(clock_);
  for (int opening = 0; opening < 2; ++opening) {
    ASSERT_TRUE(remote->open());
    EXPECT_FALSE(remote->poll(clock_.now()).value()) << "no key yet";
    clock_.advance(2s);
    const auto key = remote->poll(clock_.now()).value();
    ASSERT_TRUE(key);
    EXPECT_EQ(key->code, KEY_OK);
    EXPECT_LE(key->time, clock_.now());
    EXPECT_FALSE(remote->poll(clock_.now()).value());
    remote->close();
  }
}

}  // namespace
}  // namespace relievo
