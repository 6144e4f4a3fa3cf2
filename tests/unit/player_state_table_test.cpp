// SPDX-License-Identifier: Apache-2.0
// Every state against every event: what is not in the table is refused.
#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "app/player/state_table.h"

namespace relievo {
namespace {

// Written from the words of the states, not from the code. A row per state, a column per event; a letter is the state
// that follows, '.' a refusal. Columns: Ready Open Opened Filled FilledHeld Play Pause Seek Sought Starved EndOfFilm
// Loop Stop Fail. Letters: b(O)ot (I)dle (o)pening (B)uffering (P)laying pa(u)sed (S)eeking (E)nded (F)ault.
constexpr std::array<std::string_view, kPlayerStateCount> kExpected{
    "I............F",  // boot
    ".o............",  // idle
    "..B.........IF",  // opening
    "...PuBBS..E.IF",  // buffering
    "......uS.BE.IF",  // playing
    ".....P.S....IF",  // paused
    ".....SSSB...IF",  // seeking
    "...........SIF",  // ended
    "............I.",  // fault
};
constexpr std::string_view kLetters = "OIoBPuSEF";

TEST(StateTable, FollowsTheExpectedStateForEveryEventAndRefusesAllOthers) {
  for (std::size_t s = 0; s < kPlayerStateCount; ++s) {
    ASSERT_EQ(kExpected[s].size(), kPlayerEventCount);
    for (std::size_t e = 0; e < kPlayerEventCount; ++e) {
      const auto next = nextState(static_cast<PlayerState>(s), static_cast<PlayerEvent>(e));
      const char letter = next ? kLetters[static_cast<std::size_t>(*next)] : '.';
      EXPECT_EQ(letter, kExpected[s][e]) << name(static_cast<PlayerState>(s)) << ", event " << e;
    }
  }
}

TEST(StateTable, EveryStateIsReachedFromBootAndLeadsToIdle) {
  const auto reachable = [](PlayerState from) {
    std::array<bool, kPlayerStateCount> seen{};
    seen[static_cast<std::size_t>(from)] = true;
    for (std::size_t round = 0; round < kPlayerStateCount; ++round) {
      for (std::size_t s = 0; s < kPlayerStateCount; ++s) {
        for (std::size_t e = 0; seen[s] && e < kPlayerEventCount; ++e) {
          const auto next = nextState(static_cast<PlayerState>(s), static_cast<PlayerEvent>(e));
          if (next) seen[static_cast<std::size_t>(*next)] = true;
        }
      }
    }
    return seen;
  };
  const auto from_boot = reachable(PlayerState::Boot);
  for (std::size_t s = 0; s < kPlayerStateCount; ++s) {
    EXPECT_TRUE(from_boot[s]) << name(static_cast<PlayerState>(s));
    EXPECT_TRUE(reachable(static_cast<PlayerState>(s))[static_cast<std::size_t>(PlayerState::Idle)]);
  }
}

TEST(StateTable, NamesStatesAsTheReportDoes) {
  EXPECT_STREQ(name(PlayerState::Boot), "boot");
  EXPECT_STREQ(name(PlayerState::Buffering), "buffering");
  EXPECT_STREQ(name(PlayerState::Fault), "fault");
}

}  // namespace
}  // namespace relievo
