// SPDX-License-Identifier: Apache-2.0
// The words of the player's commands, both ways.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "app/player/control/command.h"
#include "app/player/control/verb_table.h"
#include "tests/support/command_words.h"

namespace relievo {
namespace {

using test::wordsOf;
using V = PlayerVerb;

TEST(Command, EachHasWordsThatReadBackAsItself) {
  std::set<std::string> all;
  for (std::size_t verb = 0; verb < verbTable().size(); ++verb) {
    ASSERT_EQ(verbTable()[verb].verb, static_cast<V>(verb)) << "rows in the order of PlayerVerb";
    for (const double value : {10.0, -0.5}) {
      PlayerCommand command{static_cast<V>(verb), 0};
      const std::set<V> stepped{V::SeekBy,       V::DepthBy,         V::ScreenBy,  V::ZoomBy,        V::VolumeBy,
                                V::AudioDelayBy, V::SubtitleDelayBy, V::ChapterBy, V::SubtitleSizeBy};
      if (command.verb == V::SelectBy) command.value = value < 0 ? -1 : 10;
      if (command.verb == V::SelectTo) command.value = 3;
      if (command.verb == V::RotateBy) command.value = value < 0 ? -90 : 90;
      if (stepped.contains(command.verb)) command.value = value;
      if (command.verb == V::SeekTo || command.verb == V::VolumeTo) command.value = 75.25;
      if (command.verb == V::SeekShare) command.value = 0.5;
      if (command.verb == V::Open) command.word = "http://a.b/c d.mkv";
      const auto read = parseCommand(wordsOf(command));
      ASSERT_TRUE(read) << wordsOf(command);
      EXPECT_EQ(*read, command) << wordsOf(command);
      EXPECT_FALSE(meaningOf(command).empty());
      all.insert(wordsOf(command));
    }
  }
  EXPECT_EQ(all.size(), 56U);  // no two alike; eleven with either sign
}

TEST(Command, ASeeksNumberSaysWhatItCountsFrom) {
  EXPECT_EQ(parseCommand("seek +10"), (PlayerCommand{V::SeekBy, 10}));
  EXPECT_EQ(parseCommand("seek -10"), (PlayerCommand{V::SeekBy, -10}));
  EXPECT_EQ(parseCommand("seek 10"), (PlayerCommand{V::SeekTo, 10}));
  EXPECT_EQ(parseCommand("seek 50%"), (PlayerCommand{V::SeekShare, 0.5}));
  EXPECT_EQ(parseCommand("seek 0%"), (PlayerCommand{V::SeekShare, 0}));
}

TEST(Command, APictureIsTurnedByQuarters) {
  EXPECT_EQ(parseCommand("rotate 90"), (PlayerCommand{V::RotateBy, 90}));
  EXPECT_EQ(parseCommand("rotate -270"), (PlayerCommand{V::RotateBy, -270}));
  for (const char* words : {"rotate", "rotate 45", "rotate 0", "rotate 360"})
    EXPECT_FALSE(parseCommand(words)) << words;
  EXPECT_EQ(meaningOf({V::RotateBy, -90}), "turn it 90° back");
}

TEST(Command, WhatTurnsCanAlsoBeSet) {
  EXPECT_EQ(parseCommand("loop"), (PlayerCommand{V::Loop}));
  EXPECT_EQ(parseCommand("loop on"), (PlayerCommand{V::Loop, 1}));
  EXPECT_EQ(parseCommand("loop off"), (PlayerCommand{V::Loop, -1}));
  EXPECT_EQ(parseCommand("layout"), (PlayerCommand{V::Layout}));
  EXPECT_EQ(parseCommand("layout quilt:5x9"), (PlayerCommand{V::Layout, 0, "quilt:5x9"}));
  for (const char* words : {"loop on", "loop off", "layout tab:full", "full-screen on", "full-screen off", "mute on",
                            "show-subtitles off", "subtitles 2", "subtitles off", "audio 1", "aspect 16:9"}) {
    EXPECT_EQ(wordsOf(*parseCommand(words)), words);
    EXPECT_NE(meaningOf(*parseCommand(words)),
              meaningOf(*parseCommand(std::string(words).substr(0, std::string(words).find(' ')))));
  }
  for (const char* words : {"loop maybe", "loop ", "layout 3d", "layout quilt:0x9", "layout sbs tab", "audio off",
                            "audio 0", "audio 1.5", "subtitles -1", "aspect 16", "volume", "full-screen 1", "select",
                            "select 0", "select 1.5", "select +x", "choose 2", "back 1"}) {
    EXPECT_FALSE(parseCommand(words)) << words;
  }
}

TEST(Command, TracksAreNumberedAndSubtitlesCanBeOff) {
  EXPECT_EQ(parseCommand("audio"), (PlayerCommand{V::AudioTrack}));
  EXPECT_EQ(parseCommand("audio 2"), (PlayerCommand{V::AudioTrack, 2}));
  EXPECT_EQ(parseCommand("subtitles off"), (PlayerCommand{V::SubtitleTrack, -1}));
  EXPECT_EQ(wordsOf({V::SubtitleTrack, -1}), "subtitles off");
  EXPECT_EQ(parseCommand("subtitles previous"), (PlayerCommand{V::SubtitleTrack, kPreviousTrack}));
  EXPECT_EQ(wordsOf({V::SubtitleTrack, kPreviousTrack}), "subtitles previous");
  EXPECT_EQ(meaningOf({V::SubtitleTrack, kPreviousTrack}), "the previous subtitles, or none");
  for (const char* words : {"audio off", "audio 0", "audio 1.5", "subtitles -2", "audio 1000"}) {
    EXPECT_FALSE(parseCommand(words)) << words;
  }
}

TEST(Command, AVolumesSignSaysWhetherItIsAChange) {
  EXPECT_EQ(parseCommand("volume +5"), (PlayerCommand{V::VolumeBy, 5}));
  EXPECT_EQ(parseCommand("volume 80"), (PlayerCommand{V::VolumeTo, 80}));
  EXPECT_EQ(meaningOf({V::VolumeBy, -5}), "5 % quieter");
}

TEST(Command, AShapeIsAWordOrTwoNumbers) {
  EXPECT_EQ(parseCommand("aspect 16:9"), (PlayerCommand{V::Aspect, 0, "16:9"}));
  EXPECT_EQ(parseCommand("aspect film"), (PlayerCommand{V::Aspect, 0, "film"}));
  for (const char* words : {"aspect wide", "aspect 16", "aspect 16:0", "aspect 1:100"}) {
    EXPECT_FALSE(parseCommand(words)) << words;
  }
}

TEST(Command, WhatIsNoneIsNone) {
  for (const char* words :
       {"",          " ",         "dance",    "Play",      "play now", "play ",    "seek",       "seek ",    "seek x",
        "seek 1 2",  "seek 101%", "seek -5%", "seek +5%",  "seek nan", "seek inf", "seek 1e300", "seek ++1", "seek +-1",
        "seek 0x10", "seek 5s",   "depth",    "depth 1,5", "open",     "open ",    "%",          "seek %"}) {
    EXPECT_FALSE(parseCommand(words)) << "'" << words << "'";
  }
}

TEST(Command, SaysWhichWordIsWrong) {
  EXPECT_TRUE(whyNoCommand("pase").starts_with("unknown command \"pase\"; did you mean \"pause\"? known are: play, "));
  EXPECT_TRUE(whyNoCommand("dance").starts_with("unknown command \"dance\"; known are: play, "))
      << whyNoCommand("dance");
  EXPECT_EQ(whyNoCommand("select x"), "\"select\" takes +N|-N|N|last, not \"x\"");
  EXPECT_EQ(whyNoCommand("select"), "\"select\" takes +N|-N|N|last: it is missing");
  EXPECT_EQ(whyNoCommand("audio off"), "\"audio\" takes [N|previous], not \"off\"") << "that is \"mute on\"";
  EXPECT_EQ(whyNoCommand("subtitles no"), "\"subtitles\" takes [N|previous|off], not \"no\"");
  EXPECT_EQ(whyNoCommand("pause now"), "\"pause\" takes no word after it, but \"now\" was given");
}

TEST(Command, ADelaySaysItsDirection) {
  EXPECT_EQ(meaningOf({V::SubtitleDelayBy, -0.1}), "subtitles 0.1 s earlier");
  EXPECT_EQ(meaningOf({V::SubtitleDelayBy, 0.1}), "subtitles 0.1 s later");
  EXPECT_EQ(meaningOf({V::SubtitleSizeBy, -0.1}), "subtitles 10 % smaller");
  EXPECT_EQ(meaningOf({V::ScreenBy, 2}), "the scene 2 mm towards you");
  EXPECT_EQ(meaningOf({V::DepthBy, -0.1}), "10 % less depth for the eyes");
}

TEST(Command, TheListOfWordsNamesEachOnce) {
  const std::string words = commandWords();
  EXPECT_NE(words.find("seek +S|-S|S|P%"), std::string::npos) << words;
  EXPECT_NE(words.find("open URL"), std::string::npos) << words;
  EXPECT_EQ(words.find("seek"), words.rfind("seek")) << words;
}

}  // namespace
}  // namespace relievo
