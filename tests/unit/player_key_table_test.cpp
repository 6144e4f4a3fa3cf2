// SPDX-License-Identifier: Apache-2.0
// Keys, by the numbers that the kernel's input layer and its CEC map use for them.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>

#include "app/player/key_table.h"
#include "drivers/mock/key_names.h"

namespace relievo {
namespace {

std::optional<PlayerCommand> pressed(int code, KeyEvent::Action action = KeyEvent::Action::Press) {
  return commandOf({.code = static_cast<std::uint16_t>(code), .action = action, .time = {}});
}

// Numbers, not names: a wrong name in the table shows here.
TEST(KeyTable, KnowsTheKeysOfRemotesKeyboardsAndCec) {
  const std::map<int, PlayerCommand> expected{
      {207, PlayerCommand::Play},
      {200, PlayerCommand::Play},
      {119, PlayerCommand::Pause},
      {201, PlayerCommand::Pause},
      {164, PlayerCommand::PlayPause},
      {0x160, PlayerCommand::PlayPause},
      {28, PlayerCommand::PlayPause},
      {0x161, PlayerCommand::PlayPause},
      {57, PlayerCommand::PlayPause},
      {106, PlayerCommand::SeekForward},
      {208, PlayerCommand::SeekForward},
      {105, PlayerCommand::SeekBackward},
      {168, PlayerCommand::SeekBackward},
      {0x26f, PlayerCommand::NextLayout},
      {128, PlayerCommand::Stop},
      {166, PlayerCommand::Stop},
      {158, PlayerCommand::Stop},
      {174, PlayerCommand::Stop},
      {1, PlayerCommand::Stop},
      {116, PlayerCommand::Stop},
      {15, PlayerCommand::NextLayout},
      {0x191, PlayerCommand::SwapEyes},
      {18, PlayerCommand::SwapEyes},
      {103, PlayerCommand::DeeperPicture},
      {108, PlayerCommand::FlatterPicture},
      {104, PlayerCommand::ScreenForward},
      {0x192, PlayerCommand::ScreenForward},
      {109, PlayerCommand::ScreenBackward},
      {0x193, PlayerCommand::ScreenBackward},
      {0x166, PlayerCommand::Info},
      {23, PlayerCommand::Info},
      {31, PlayerCommand::NextLayout},
  };
  for (int code = 0; code <= 0x2ff; ++code) {
    const auto known = expected.find(code);
    if (known == expected.end()) {
      EXPECT_FALSE(pressed(code)) << code;
    } else {
      EXPECT_EQ(pressed(code), known->second) << code;
    }
  }
}

// The names that the help lists are those that a script takes, each with its command.
TEST(KeyTable, HelpNamesEveryKeyAsScriptsDo) {
  std::istringstream help(keyHelp());
  int lines = 0, names = 0;
  for (std::string line; std::getline(help, line); ++lines) {
    std::istringstream words(line.substr(0, line.find("   ")));
    std::optional<PlayerCommand> command;
    for (std::string word; words >> word; ++names) {
      const auto code = keyCode(word);
      ASSERT_TRUE(code) << word;
      const auto meant = pressed(*code);
      ASSERT_TRUE(meant) << word;
      EXPECT_EQ(*meant, command.value_or(*meant)) << word << " is on the line of another command";
      command = meant;
    }
  }
  EXPECT_EQ(lines, 13);
  EXPECT_EQ(names, 32);
}

TEST(KeyTable, AHeldKeySeeksOnAndDoesNothingElse) {
  EXPECT_EQ(pressed(106, KeyEvent::Action::Repeat), PlayerCommand::SeekForward);
  EXPECT_EQ(pressed(105, KeyEvent::Action::Repeat), PlayerCommand::SeekBackward);
  EXPECT_FALSE(pressed(164, KeyEvent::Action::Repeat));
  EXPECT_FALSE(pressed(0x26f, KeyEvent::Action::Repeat));
}

TEST(KeyTable, AReleaseMeansNothing) {
  EXPECT_FALSE(pressed(164, KeyEvent::Action::Release));
  EXPECT_FALSE(pressed(128, KeyEvent::Action::Release));
}

}  // namespace
}  // namespace relievo
