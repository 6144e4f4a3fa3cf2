// SPDX-License-Identifier: Apache-2.0
// What a misspelt word was meant to be.
#include "platform/text/near_words.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "platform/text/lower_case.h"

namespace relievo {
namespace {

TEST(NearWords, CountTheLettersToChange) {
  EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(editDistance("", "abc"), 3U);
  EXPECT_EQ(editDistance("same", "same"), 0U);
  EXPECT_EQ(editDistance("paly", "play"), 1U) << "two neighbours are swapped";
  EXPECT_EQ(editDistance("abcd", "badc"), 2U);
}

TEST(NearWords, FindTheNearestWhateverItsCaseAndNoneThatIsFar) {
  const std::vector<std::string> words{"--stereo", "--resume", "--report"};
  EXPECT_EQ(nearestWord("--Sterio", words), "--stereo");
  EXPECT_EQ(nearestWord("--repot", words), "--report");
  EXPECT_EQ(nearestWord("--window", words), "");
  EXPECT_EQ(nearestWord("x", {}), "");
  EXPECT_EQ(nearestWord("--fs", std::vector<std::string>{"--as"}), "") << "one letter of two is another word";
  EXPECT_EQ(nearestWord("paly", std::vector<std::string>{"probe", "play"}), "play");
  EXPECT_EQ(lowerCase("SBS:Full-1\xc3\x84"), "sbs:full-1\xc3\x84");
}

TEST(NearWords, FindTheOneThatWasBrokenOff) {
  const std::vector<std::string> words{"--volume", "--depth", "--depth-code", "--depth-from"};
  EXPECT_EQ(nearestWord("--Vol", words), "--volume");
  EXPECT_EQ(nearestWord("--dep", words), "") << "several begin so";
  EXPECT_EQ(nearestWord("--vo", words), "") << "that is little";
  EXPECT_EQ(nearestWord("--", words), "");
}

}  // namespace
}  // namespace relievo
