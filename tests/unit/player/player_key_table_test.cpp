// SPDX-License-Identifier: Apache-2.0
// Keys, by the numbers that the kernel's input layer and its CEC map use for them; tables from files.
#include "app/player/control/key_table.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <map>
#include <ranges>
#include <sstream>
#include <string>

#include "app/player/control/key_label.h"
#include "hal/key_names.h"
#include "hal/key_signs.h"
#include "tests/support/command_words.h"

namespace relievo {
namespace {

using test::wordsOf;

using State = PlayerState;

std::optional<PlayerCommand> pressed(const KeyTable& table, State state, int code) {
  const KeyTable::Binding* binding = table.find(state, static_cast<std::uint16_t>(code));
  return binding == nullptr ? std::nullopt : binding->press;
}

// What a key means while a film plays. Numbers, not names: a wrong name in the table shows here.
const std::map<int, std::string> kMeanings{
    // mpv's
    {57, "play-pause"},
    {25, "play-pause"},
    {33, "full-screen"},
    {87, "full-screen"},
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

// What a hint tells a viewer to press.
TEST(KeyTable, NamesTheKeyOfACommandAsTheViewerReadsIt) {
  const KeyTable table = KeyTable::usual();
  EXPECT_EQ(table.keyFor(PlayerVerb::Keys, State::Playing, KeyBoard::Keyboard), "h");
  EXPECT_EQ(table.keyFor(PlayerVerb::Keys, State::Playing, KeyBoard::Remote), "Help or Menu");
  EXPECT_EQ(table.keyFor(PlayerVerb::Layout, State::Playing, KeyBoard::Remote), "Blue or 3D");
  EXPECT_EQ(table.keyFor(PlayerVerb::Screenshot, State::Playing, KeyBoard::Remote), "");
  EXPECT_EQ(table.keyFor(PlayerVerb::Keys, State::Playing, KeyBoard::Pad), "Pad Start");
  EXPECT_EQ(keyLabel(KEY_UNKNOWN, KeyBoard::Keyboard), "") << "such as a letter with an accent";
}

// Keys are named as they are labelled on the keyboard or remote that the viewer uses.
TEST(KeyTable, ThePageNamesKeysAsTheyAreLabelled) {
  const KeyTable table = KeyTable::usual();
  const auto keyOf = [&](State state, KeyBoard held, const std::string& meaning) {
    for (const auto& [key, what] : table.rowsIn(state, held)) {
      if (what == meaning) return key;
    }
    return std::string();
  };
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Keyboard, "pause or continue"), "p, Space, Enter");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Remote, "pause or continue"), "Play/Pause, OK");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Keyboard, "slower, down to 1/8, with touch"), "[");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Keyboard, "to 10 % .. 80 % of the film"), "1 .. 8");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Remote, "to 10 % .. 90 % of the film"), "1 .. 9");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Keyboard, "subtitles 0.1 s earlier"), "z");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Keyboard, "the scene 2 mm away from you"), "F4");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Keyboard, "sound 0.1 s earlier"), "Ctrl+-");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Keyboard, "the next chapter"), "Page Up, @");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Keyboard, "subtitles 10 % larger"), "Shift+g");
  EXPECT_EQ(keyOf(State::Browsing, KeyBoard::Keyboard, "the last film"), "End");
  EXPECT_EQ(keyOf(State::Browsing, KeyBoard::Keyboard, "play the selected film"), "Space, Right, Enter");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Pad, "pause or continue"), "Pad A or Cross");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Pad, "5 % louder"), "Pad right stick up");
  EXPECT_EQ(keyOf(State::Playing, KeyBoard::Pad, "end the program"), "Pad Guide (held)");
  EXPECT_EQ(keyOf(State::Browsing, KeyBoard::Pad, "play the selected film"), "Pad Right, Pad A or Cross");
  for (const KeyBoard held : {KeyBoard::Keyboard, KeyBoard::Remote}) {
    for (const auto& [key, what] : table.rowsIn(State::Playing, held)) EXPECT_EQ(key.find("Pad"), key.npos) << key;
  }
  for (const auto& [key, what] : table.rowsIn(State::Playing, KeyBoard::Keyboard)) {
    for (const char* remote : {"OK", "Channel", "Red", "BRACE", "NUMERIC"}) {
      EXPECT_EQ(key.find(remote), std::string::npos) << key;
    }
  }
}

TEST(KeyTable, ThePageNamesSmallStepsFirst) {
  std::vector<std::string> seeks;
  for (const auto& [key, what] : KeyTable::usual().rowsIn(State::Playing, KeyBoard::Keyboard)) {
    if (what.ends_with(" s back") || what.ends_with(" s forward")) seeks.push_back(what);
  }
  EXPECT_EQ(seeks, (std::vector<std::string>{"1 s back", "1 s forward", "5 s back", "5 s forward", "60 s back",
                                             "60 s forward", "600 s back", "600 s forward"}));
}

// The names that the help lists are those that a script takes.
TEST(KeyTable, HelpNamesEveryKeyAsScriptsDo) {
  std::istringstream help(KeyTable::usual().help());
  int names = 0;
  for (std::string line; std::getline(help, line);) {
    std::istringstream words(line.substr(0, line.find("  ", 2)));
    for (std::string word; words >> word;) {
      if (word.starts_with('(')) continue;  // when
      ASSERT_TRUE(keyCode(word)) << word;
      ++names;
    }
  }
  EXPECT_EQ(names, 135);
}

TEST(KeyTable, AFileChangesRowsAndLeavesTheRest) {
  const auto table = KeyTable::parse(
      "[always]\nRIGHT = \"seek +30\"\nBLUE = \"\"\nENTER = \"info\"\n"
      "[playing]\nOK = { press = \"pause\", hold = \"stop\" }\n",
      "keys.toml");
  ASSERT_TRUE(table) << table.error().thing;
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, KEY_RIGHT)), "seek +30");
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, KEY_LEFT)), "seek -5");
  EXPECT_FALSE(pressed(*table, State::Playing, KEY_BLUE));
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, KEY_OK)), "pause");
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, KEY_SELECT)), "pause");  // its twin
  EXPECT_EQ(wordsOf(*pressed(*table, State::Paused, KEY_OK)), "play-pause");
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, KEY_ENTER)), "info");  // said for itself
  EXPECT_EQ(table->find(State::Playing, KEY_OK)->hold, (PlayerCommand{PlayerVerb::Stop}));
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, BTN_SOUTH)), "pause");  // a gamepad's twin
  const auto pad = KeyTable::parse("[always]\nBTN_SOUTH = \"step\"\n", "keys.toml");
  ASSERT_TRUE(pad) << pad.error().thing;
  EXPECT_EQ(wordsOf(*pressed(*pad, State::Playing, BTN_SOUTH)), "step");
  EXPECT_EQ(wordsOf(*pressed(*pad, State::Playing, KEY_OK)), "play-pause");
}

class KeyTableWrong : public testing::TestWithParam<std::pair<const char*, const char*>> {};
TEST_P(KeyTableWrong, NamesTheLineAndTheWord) {
  const auto table = KeyTable::parse(GetParam().first, "k.toml");
  ASSERT_FALSE(table) << GetParam().first;
  EXPECT_EQ(table.error().error.code, ErrorCode::InvalidArgument);
  EXPECT_EQ(table.error().thing.find("k.toml:2"), 0U) << table.error().thing;
  EXPECT_NE(table.error().thing.find(GetParam().second), std::string::npos) << table.error().thing;
}
INSTANTIATE_TEST_SUITE_P(Lines, KeyTableWrong,
                         testing::Values(std::pair{"[always]\nRIGT = \"stop\"", "RIGHT?"},
                                         std::pair{"[always]\nRIGHT = \"dance\"", "\"dance\""},
                                         std::pair{"[always]\nRIGHT = \"pase\"", "did you mean \"pause\"?"},
                                         std::pair{"[always]\nRIGHT = \"loop x\"", "takes [on|off]"},
                                         std::pair{"[always]\nRIGHT = 10", ""},
                                         std::pair{"[always]\nRIGHT = [\"stop\"]", ""},
                                         std::pair{"[always]\nRIGHT = { push = \"stop\" }", "push"},
                                         std::pair{"[always]\nRIGHT = { hold = \"dance\" }", "\"dance\""},
                                         std::pair{"[always]\nRIGHT stop", ""},
                                         std::pair{"[paused]\n[asleep]\nRIGHT = \"stop\"", ""},
                                         std::pair{"\nRIGHT = \"stop\"", "RIGHT"}));

TEST(KeyTable, NamesThatNestTooDeepAreNoToml) {
  std::string deep = "# " + std::string(200, '.') + "\n[always";
  for (int i = 0; i < 60'000; ++i) deep += ".a";
  const auto table = KeyTable::parse(deep + "]\n", "k.toml");
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().thing, "k.toml:2");
}

TEST(KeyTable, AKeyThatMeansNothingInAStateMeansNothingThere) {
  const auto table = KeyTable::parse("[paused]\nRIGHT = \"\"\n", "k");
  ASSERT_TRUE(table);
  EXPECT_EQ(pressed(*table, State::Paused, KEY_RIGHT), std::nullopt) << "though it has a meaning in [always]";
  EXPECT_TRUE(pressed(*table, State::Playing, KEY_RIGHT));
}

TEST(KeyTable, AMissingFileIsNotFound) {
  EXPECT_EQ(KeyTable::load("/nonexistent/keys.toml").error().error.code, ErrorCode::NotFound);
}

TEST(KeyTable, ItsOwnTextReadsBack) {
  EXPECT_TRUE(KeyTable::parse(KeyTable::usualText(), "usual"));
}

TEST(KeyTable, AKeyWithShiftOrCtrlIsARowOfItsOwn) {
  const auto table = KeyTable::parse("[always]\nCTRL_Q = \"\"\nSHIFT_RIGHT = \"seek +1\"\n", "keys.toml");
  ASSERT_TRUE(table) << table.error().thing;
  EXPECT_EQ(keyName(KEY_RIGHT | kWithShift), "SHIFT_RIGHT");
  EXPECT_EQ(keyName(KEY_Q | kWithShift | kWithCtrl), "CTRL_SHIFT_Q");
  EXPECT_EQ(keyCode("key_ctrl_q"), std::nullopt);
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, KEY_RIGHT | kWithShift)), "seek +1");
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, KEY_RIGHT | kWithCtrl)), "seek +5");
  EXPECT_FALSE(pressed(*table, State::Playing, KEY_Q | kWithCtrl)) << "it is told to mean nothing";
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, KEY_7)), "seek 70%");
  EXPECT_TRUE(pressed(*table, State::Playing, KEY_9));
  for (const int digit : {KEY_7, KEY_8, KEY_9, KEY_0}) {
    EXPECT_FALSE(pressed(*table, State::Playing, static_cast<std::uint16_t>(digit | kWithShift)))
        << keyName(static_cast<std::uint16_t>(digit)) << ": another sign in most layouts";
  }
  EXPECT_EQ(wordsOf(*pressed(*table, State::Playing, KEY_Q)), "quit");
}

// What a window and a terminal make of a sign, the page of keys calls by that sign, and keys.toml has a name for it.
TEST(KeyTable, EverySignIsAKeyWithThatLabelAndAName) {
  for (const char sign : std::string("!\"#$%&'()*+,-./:;<=>?@[\\]^_`{|}~")) {
    const auto code = keyOfSign(sign);
    ASSERT_TRUE(code) << sign;
    EXPECT_EQ(signOfKey(*code), sign);
    EXPECT_EQ(keyboardLabel(*code)[0], sign);
    EXPECT_EQ(keyCode(keyName(*code)), code) << sign;
  }
  EXPECT_EQ(keyboardLabel(KEY_DOT), ". (dot)");
  EXPECT_EQ(keyboardLabel(KEY_RIGHT | kWithShift), "Shift+Right");
  EXPECT_EQ(keyOfSign('a'), std::nullopt);
  EXPECT_EQ(signOfKey(KEY_A), '\0');
}

}  // namespace
}  // namespace relievo
