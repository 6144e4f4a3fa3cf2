// SPDX-License-Identifier: Apache-2.0
// Tables of keys from files.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <string>
#include <utility>

#include "app/player/control/key_table.h"
#include "hal/key_names.h"
#include "tests/support/command_words.h"
#include "tests/unit/player/keys/pressed_key.h"

namespace relievo {
namespace {

using test::pressed;
using test::wordsOf;

using State = PlayerState;

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

}  // namespace
}  // namespace relievo
