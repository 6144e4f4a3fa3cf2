// SPDX-License-Identifier: Apache-2.0
// Keys, by the numbers that the kernel's input layer and its CEC map use for them.
#include "app/player/control/key_table.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <algorithm>
#include <map>
#include <ranges>
#include <string>

#include "tests/support/command_words.h"
#include "tests/unit/player/keys/pressed_key.h"

namespace relievo {
namespace {

using test::pressed;
using test::wordsOf;

using State = PlayerState;

// What a key means while a film plays. Numbers, not names: a wrong name in the table shows here.
const std::map<int, std::string> kMeanings{
    // mpv's
    {57, "play-pause"},
    {25, "play-pause"},
    {33, "full-screen"},
    {87, "full-screen"},
    {43, "full-screen"},
    {1, "escape"},
    {16, "quit"},
    {106, "seek +5"},
    {105, "seek -5"},
    {103, "seek +60"},
    {108, "seek -60"},
    {102, "seek 0%"},
    {52, "step"},
    {51, "step-back"},
    {26, "slower"},
    {27, "faster"},
    {14, "normal-speed"},
    {104, "chapter +1"},
    {109, "chapter -1"},
    {38, "ab-loop"},
    {11, "volume +5"},
    {10, "volume -5"},
    {13, "volume +5"},
    {12, "volume -5"},
    {78, "volume +5"},
    {74, "volume -5"},
    {55, "volume +5"},
    {98, "volume -5"},
    {50, "mute"},
    {47, "show-subtitles"},
    {36, "subtitles"},
    {44, "subtitle-delay -0.1"},
    {45, "subtitle-delay +0.1"},
    {0x20b, "audio"},
    {31, "screenshot"},
    {17, "zoom -0.1"},
    {18, "zoom +0.1"},
    {19, "rotate +90"},
    {20, "show-subtitles"},
    {66, "mute"},
    {30, "aspect"},
    {24, "info"},
    {23, "statistics"},
    {35, "keys"},
    {59, "keys"},
    {214, "keys"},
    {49, "next"},
    {48, "previous"},
    // depth and eyes
    {15, "layout"},
    {0x26f, "layout"},
    {21, "swap-eyes"},
    {0x191, "layout"},
    {60, "depth -0.1"},
    {0x18f, "depth -0.1"},
    {61, "depth +0.1"},
    {0x190, "depth +0.1"},
    {62, "screen -2"},
    {63, "screen +2"},
    // a remote control's
    {207, "play"},
    {200, "play"},
    {119, "pause"},
    {201, "pause"},
    {164, "play-pause"},
    {0x160, "play-pause"},
    {28, "play-pause"},
    {0x161, "play-pause"},
    {96, "play-pause"},
    {128, "stop"},
    {166, "stop"},
    {158, "back"},
    {174, "back"},
    {116, "stop"},
    {159, "seek +10"},
    {168, "seek -10"},
    {208, "faster"},
    {0x199, "slower"},
    {0x197, "next"},
    {163, "next"},
    {0x192, "next"},
    {0x19c, "previous"},
    {165, "previous"},
    {0x193, "previous"},
    {0x18e, "loop"},
    {115, "volume +5"},
    {114, "volume -5"},
    {113, "mute"},
    {0x172, "subtitles"},
    {0x188, "audio"},
    {0x170, "audio"},
    {0x174, "full-screen"},
    {0x166, "info"},
    {139, "keys"},
    {138, "keys"},
    // a gamepad's
    {0x130, "play-pause"},
    {0x131, "back"},
    {0x133, "subtitles"},
    {0x134, "layout"},
    {0x136, "chapter -1"},
    {0x137, "chapter +1"},
    {0x13a, "info"},
    {0x13b, "keys"},
    {0x13e, "mute"},
    {0x220, "seek +60"},
    {0x221, "seek -60"},
    {0x222, "seek -5"},
    {0x223, "seek +5"},
};

TEST(KeyTable, KnowsTheKeysOfRemotesKeyboardsAndCec) {
  std::map<int, std::string> expected = kMeanings;
  for (int digit = 0; digit <= 9; ++digit) {
    const std::string words = "seek " + std::to_string(10 * digit) + "%";
    if (digit >= 1 && digit <= 8) expected[1 + digit] = words;
    expected[0x200 + digit] = words;
  }
  const KeyTable table = KeyTable::usual();
  for (int code = 0; code <= 0x2ff; ++code) {
    const auto known = expected.find(code);
    const auto command = pressed(table, State::Playing, code);
    ASSERT_EQ(command.has_value(), known != expected.end()) << code;
    if (command) {
      EXPECT_EQ(wordsOf(*command), known->second) << code;
    }
  }
}

TEST(KeyTable, AStateHasRowsOfItsOwn) {
  const KeyTable table = KeyTable::usual();
  EXPECT_EQ(pressed(table, State::Paused, KEY_FASTFORWARD), (PlayerCommand{PlayerVerb::Step}));
  EXPECT_EQ(pressed(table, State::Playing, KEY_FASTFORWARD), (PlayerCommand{PlayerVerb::Faster}));
  EXPECT_EQ(pressed(table, State::Paused, KEY_STOP), (PlayerCommand{PlayerVerb::Stop}));
}

// In the list of films the usual keys of a remote choose, and its help names no key of a film.
TEST(KeyTable, TheListOfFilmsHasAFewKeys) {
  const KeyTable table = KeyTable::usual();
  EXPECT_EQ(pressed(table, State::Browsing, KEY_UP), (PlayerCommand{PlayerVerb::SelectBy, -1}));
  EXPECT_EQ(pressed(table, State::Browsing, KEY_DOWN), (PlayerCommand{PlayerVerb::SelectBy, 1}));
  EXPECT_EQ(pressed(table, State::Browsing, KEY_ENTER), (PlayerCommand{PlayerVerb::Choose}));
  EXPECT_EQ(pressed(table, State::Browsing, KEY_STOP), std::nullopt);
  EXPECT_EQ(pressed(table, State::Playing, KEY_UP), (PlayerCommand{PlayerVerb::SeekBy, 60}));
  EXPECT_EQ(pressed(table, State::Browsing, KEY_HOME), (PlayerCommand{PlayerVerb::SelectTo, 1}));
  EXPECT_EQ(pressed(table, State::Browsing, KEY_END), (PlayerCommand{PlayerVerb::SelectTo}));
  const auto rows = table.rowsIn(State::Browsing, KeyBoard::Remote);
  const auto meanings = rows | std::views::values;
  EXPECT_NE(std::ranges::find(meanings, "one film down"), meanings.end());
  EXPECT_EQ(std::ranges::find(meanings, "5 s forward"), meanings.end());
  EXPECT_LT(rows.size(), 20u);
}

}  // namespace
}  // namespace relievo
