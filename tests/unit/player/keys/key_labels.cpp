// SPDX-License-Identifier: Apache-2.0
// Keys as the page of keys, hints and the help name them.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <sstream>
#include <string>
#include <vector>

#include "app/player/control/key_label.h"
#include "app/player/control/key_table.h"
#include "hal/key_names.h"
#include "hal/key_signs.h"

namespace relievo {
namespace {

using State = PlayerState;

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
  EXPECT_EQ(names, 140);
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
