// SPDX-License-Identifier: Apache-2.0
// Every state against every event: what is not in the table is refused.
#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "app/player/state_table.h"

namespace relievo {
namespace {

// Written from the words of the states, not from the code. A row per state, a column per event; a letter is the state
// that follows, '.' a refusal. Columns: Ready broWse Open Opened Filled FilledHeld Play Pause sTep Rate Seek soUght
// starVed EndOfFilm Loop stoP Fail. Letters: b(O)ot (I)dle bro(w)sing (o)pening (B)uffering (P)laying pa(u)sed
// (S)eeking (E)nded (F)ault.
constexpr std::array<std::string_view, kPlayerStateCount> kExpected{
    // RWOOFFPPTRSUVELPF
    "I...............F",  // boot
    ".wo.............F",  // idle
    "..o............IF",  // browsing
    "..oB..oo..o....IF",  // opening
    "..o.PuBB.BS..E.IF",  // buffering
    "..o....uuPS.BE.IF",  // playing
    "..o...P.uuS....IF",  // paused
    "..o...SS.SSB...IF",  // seeking
    "..o...........SIF",  // ended
    "..o............I.",  // fault
};
constexpr std::string_view kLetters = "OIwoBPuSEF";

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

// Every row of the table is on the drawing, and nothing else is.
TEST(StateTable, TheDrawingIsTheTable) {
  const std::string graph = stateGraph();
  std::size_t rows = 0;
  for (std::size_t s = 0; s < kPlayerStateCount; ++s) {
    for (std::size_t e = 0; e < kPlayerEventCount; ++e) {
      const auto event = static_cast<PlayerEvent>(e);
      const auto next = nextState(static_cast<PlayerState>(s), event);
      if (!next) continue;
      ++rows;
      const std::string arrow = std::string(name(static_cast<PlayerState>(s))) + " -> " + name(*next) + " [label=\"";
      const std::size_t at = graph.find(arrow);
      ASSERT_NE(at, std::string::npos) << arrow;
      const std::string label =
          "\\n" + graph.substr(at + arrow.size(), graph.find("\"]", at) - at - arrow.size()) + "\\n";
      EXPECT_NE(label.find(std::string("\\n") + name(event) + "\\n"), std::string::npos) << arrow << name(event);
    }
  }
  std::size_t labels = 0;
  for (std::size_t at = graph.find("label"); at != std::string::npos; at = graph.find("label", at + 1)) ++labels;
  for (std::size_t at = graph.find("\\n"); at != std::string::npos; at = graph.find("\\n", at + 1)) ++labels;
  EXPECT_EQ(labels, rows);
}

}  // namespace
}  // namespace relievo
