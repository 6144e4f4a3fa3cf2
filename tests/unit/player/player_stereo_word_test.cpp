// SPDX-License-Identifier: Apache-2.0
// Layouts and their variants, by their words.
#include "app/player/screen/stereo_word.h"

#include <gtest/gtest.h>

#include <string>

namespace relievo {
namespace {

TEST(StereoWord, EveryLayoutIsReadByItsName) {
  for (int i = 0; i < kStereoLayouts; ++i) {
    const auto layout = static_cast<StereoLayout>(i);
    StereoSettings settings;
    EXPECT_TRUE(parseStereo(name(layout), settings));
    EXPECT_EQ(settings.layout, layout);
    EXPECT_FALSE(settings.full);
  }
  EXPECT_STREQ(name(static_cast<StereoLayout>(kStereoLayouts)), "") << "kStereoLayouts leaves out a layout";
}

TEST(StereoWord, VariantsChangeWhatTheyNameAlone) {
  StereoSettings settings{.strength = 0.5};
  EXPECT_TRUE(parseStereo("sbs:full", settings));
  EXPECT_TRUE(settings.full);
  EXPECT_EQ(settings.strength, 0.5) << "and nothing else";
  EXPECT_TRUE(parseStereo("tab", settings));
  EXPECT_FALSE(settings.full);
  EXPECT_TRUE(parseStereo("anaglyph:gray", settings));
  EXPECT_EQ(settings.anaglyph, AnaglyphColors::Gray);
  EXPECT_TRUE(parseStereo("anaglyph:color", settings));
  EXPECT_EQ(settings.anaglyph, AnaglyphColors::Color);
  EXPECT_TRUE(parseStereo("quilt:5x9", settings));
  EXPECT_EQ(settings.quilt_cols, 5);
  EXPECT_EQ(settings.quilt_rows, 9);
}

TEST(StereoWord, IsSaidAsItWasRead) {
  for (const char* word : {"mono", "sbs", "sbs:full", "tab", "tab:full", "rows", "columns", "anaglyph", "anaglyph:gray",
                           "anaglyph:color", "frame-packing", "quilt:8x6", "quilt:5x9"}) {
    StereoSettings settings{.full = true, .anaglyph = AnaglyphColors::Dubois};
    ASSERT_TRUE(parseStereo(word, settings));
    EXPECT_EQ(stereoWord(settings), word);
  }
}

TEST(StereoWord, WhatIsNoneChangesNothing) {
  for (const char* word : {"", "sb", "sbsx", "mono:full", "sbs:", "sbs:half", "anaglyph:red", "quilt:8", "quilt:0x6",
                           "quilt:8x6x", "quilt:x6", "quilt:101x1", "frame-packing:full", ":full"}) {
    StereoSettings settings{.layout = StereoLayout::Columns};
    EXPECT_FALSE(parseStereo(word, settings)) << word;
    EXPECT_EQ(settings.layout, StereoLayout::Columns) << word;
    EXPECT_EQ(settings.quilt_cols, 8) << word;
  }
}

}  // namespace
}  // namespace relievo
