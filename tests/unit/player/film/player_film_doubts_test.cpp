// SPDX-License-Identifier: Apache-2.0
// Which doubts about films are shown over their pictures, and when.
#include "app/player/film/film_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Words = std::vector<std::string>;

Words shown(FilmDoubts& doubts) {
  Words all;
  while (const auto doubt = doubts.next()) all.push_back(*doubt);
  return all;
}

TEST(FilmDoubts, AreShownOneAfterTheOther) {
  FilmDoubts doubts;
  doubts.begin({.doubts = {"flat", "too wide"}});
  EXPECT_EQ(doubts.next(), "flat");
  EXPECT_EQ(doubts.next(), "too wide");
  EXPECT_EQ(doubts.next(), std::nullopt);
}

TEST(FilmDoubts, ANearEndThatIsTakenAsUsualIsLeftToTheTerminal) {
  FilmDoubts doubts;
  doubts.begin({.doubts = {"which end is near?", "too wide"}, .near_end_is_usual = true});
  EXPECT_THAT(shown(doubts), ElementsAre("too wide"));
  doubts.begin({.doubts = {"which end is near?"}, .near_end_is_usual = true});
  EXPECT_THAT(shown(doubts), IsEmpty());
  doubts.begin({.doubts = {"which end is near?"}});
  EXPECT_THAT(shown(doubts), ElementsAre("which end is near?"));
}

TEST(FilmDoubts, GoWithTheirFilm) {
  FilmDoubts doubts;
  doubts.begin({.doubts = {"flat", "too wide"}});
  EXPECT_EQ(doubts.next(), "flat");
  EXPECT_THAT(doubts.end(), ElementsAre("flat")) << "the one that is shown";
  EXPECT_THAT(shown(doubts), IsEmpty());
  doubts.begin({});
  EXPECT_THAT(shown(doubts), IsEmpty());
}

TEST(FilmDoubts, ThatWereNotShownAreShownWithTheNextFilmThatHasThem) {
  FilmDoubts doubts;
  doubts.begin({.doubts = {"flat", "too wide"}});
  EXPECT_EQ(doubts.next(), "flat");
  static_cast<void>(doubts.end());
  doubts.begin({.doubts = {"flat", "too wide"}});
  EXPECT_THAT(shown(doubts), ElementsAre("too wide"));
}

// A film that is opened again for its next round, or a list whose films are all alike.
TEST(FilmDoubts, ThatFollowEachOtherAreShownOnce) {
  FilmDoubts doubts;
  doubts.begin({.doubts = {"flat"}});
  EXPECT_THAT(shown(doubts), ElementsAre("flat"));
  static_cast<void>(doubts.end());
  doubts.begin({.doubts = {"flat", "too wide"}});
  EXPECT_THAT(shown(doubts), ElementsAre("too wide"));
}

}  // namespace
}  // namespace relievo
