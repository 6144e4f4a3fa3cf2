// SPDX-License-Identifier: Apache-2.0
// The list of films alone: which one comes next, after an end and after a fault, and where each was left.
#include "app/player/film/programme.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace relievo {
namespace {

using Way = Programme::Way;

constexpr MonotonicTime kStart{};

FileWriter& writer() {
  static FileWriter at_once(FileWriter::Where::AtOnce);
  return at_once;
}

std::vector<PlaylistEntry> films(const std::vector<std::string>& urls) {
  std::vector<PlaylistEntry> list;
  for (const std::string& url : urls) list.push_back({.url = url, .depth_url = "", .title = ""});
  return list;
}

// A list of these films, at the first of them.
void begin(Programme& programme, const std::vector<std::string>& urls) {
  programme.begin(films({"list"}));
  programme.choose(programme.spread(films(urls)).value_or(99), Way::Forward);
}

TEST(Programme, IsOneNamelessFilmUntilOneIsAskedFor) {
  Programme programme("", writer(), false);
  EXPECT_FALSE(programme.asked());
  EXPECT_EQ(programme.film().url, "");
  programme.begin(films({"a"}));
  EXPECT_TRUE(programme.asked());
  EXPECT_EQ(programme.film().url, "a");
  EXPECT_EQ(programme.afterEnd(), std::nullopt);
}

TEST(Programme, AListTakesThePlaceOfItsEntry) {
  Programme programme("", writer(), false);
  begin(programme, {"a", "inner", "d"});
  programme.choose(1, Way::Forward);
  EXPECT_EQ(programme.spread(films({"b", "c"})), 1U);
  std::string all;
  for (std::size_t i = 0; i < programme.size(); ++i) {
    programme.choose(i, Way::Forward);
    all += programme.film().url;
  }
  EXPECT_EQ(all, "abcd");
}

TEST(Programme, AListThatNamesItselfEnds) {
  Programme programme("", writer(), false);
  programme.begin(films({"list"}));
  int lists = 0;
  while (lists < 100 && programme.spread(films({"list"}))) ++lists;
  EXPECT_EQ(lists, Programme::kMostLists);
}

TEST(Programme, AfterTheLastFilmItEndsOrBeginsAgain) {
  Programme programme("", writer(), false);
  begin(programme, {"a", "b"});
  EXPECT_EQ(programme.afterEnd(), 1U);
  programme.choose(1, Way::Forward);
  EXPECT_EQ(programme.afterEnd(), std::nullopt);
  programme.setLoop(true);
  EXPECT_EQ(programme.afterEnd(), 0U);
}

TEST(Programme, ASingleFilmThatLoopsFollowsItself) {
  Programme programme("", writer(), true);
  programme.begin(films({"a"}));
  EXPECT_EQ(programme.afterEnd(), programme.present());
}

TEST(Programme, AFaultIsPassedOverOnTheViewersWay) {
  Programme programme("", writer(), false);
  begin(programme, {"a", "b", "c"});
  programme.choose(1, Way::Back);
  EXPECT_EQ(programme.afterFault(), 0U);
  EXPECT_EQ(programme.passOver(0), Way::Back);
  programme.opened();  // the viewer has arrived: from here on it goes forward
  EXPECT_EQ(programme.afterFault(), 2U);
  EXPECT_EQ(programme.passOver(2), Way::Forward);
}

TEST(Programme, BackAtTheFirstFilmAFaultGoesForward) {
  Programme programme("", writer(), false);
  begin(programme, {"a", "b"});
  programme.choose(0, Way::Back);
  EXPECT_EQ(programme.afterFault(), 1U);
  EXPECT_EQ(programme.passOver(1), Way::Forward);
}

TEST(Programme, ALoopWithoutAPlayableFilmEnds) {
  Programme programme("", writer(), true);
  begin(programme, {"a", "b"});
  programme.left(true);  // once all of it could be played
  int faults = 0;
  for (auto other = programme.afterFault(); other && faults < 100; other = programme.afterFault()) {
    programme.choose(*other, programme.passOver(*other));
    programme.left(false);
    ++faults;
  }
  EXPECT_EQ(faults, 3);  // b, a, b
}

class ProgrammeWithPlaces : public testing::Test {
 protected:
  ~ProgrammeWithPlaces() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_ = testing::TempDir() + "programme-" + std::to_string(::getpid());
  std::string path_ = folder_ / "places.json";
};

TEST_F(ProgrammeWithPlaces, AFilmGoesOnWhereItWasLeftUnlessItIsOver) {
  Programme programme(path_, writer(), false);
  programme.begin(films({"http://a"}));
  programme.keepAtOnce(mediaTime(30), kStart);
  EXPECT_EQ(programme.whereLeft(std::chrono::seconds(60)), mediaTime(30));
  EXPECT_EQ(programme.whereLeft(std::chrono::seconds(30)), std::nullopt) << "beyond its end";
  EXPECT_EQ(programme.whereLeft(Duration(0)), std::nullopt) << "live";
  programme.forgetPlace();
  EXPECT_EQ(programme.whereLeft(std::chrono::seconds(60)), std::nullopt);
}

TEST_F(ProgrammeWithPlaces, APlaceIsKeptNowAndThenAndAtOnceWhereTheFilmIsLeft) {
  Programme programme(path_, writer(), false);
  programme.begin(films({"http://a"}));
  const Duration length = std::chrono::seconds(60);
  programme.keep(mediaTime(10), kStart);
  programme.keep(mediaTime(11), kStart + Programme::kKeepPeriod - Duration(1));
  EXPECT_EQ(programme.whereLeft(length), mediaTime(10));
  programme.keep(mediaTime(12), kStart + Programme::kKeepPeriod);
  EXPECT_EQ(programme.whereLeft(length), mediaTime(12));
  programme.keepAtOnce(mediaTime(13), kStart + Programme::kKeepPeriod);
  programme.keepAtOnce(std::nullopt, kStart + 2 * Programme::kKeepPeriod);
  EXPECT_EQ(programme.whereLeft(length), mediaTime(13));
}

TEST_F(ProgrammeWithPlaces, AListBeginsWithTheFilmSeenLast) {
  {
    Programme before(path_, writer(), false);
    before.begin(films({"http://b"}));
    before.keepAtOnce(mediaTime(30), kStart);
  }
  Programme programme(path_, writer(), false);
  programme.begin(films({"list"}));
  EXPECT_EQ(programme.spread(films({"http://a", "http://b", "http://c"})), 1U);
}

TEST_F(ProgrammeWithPlaces, AListAfterTheFilmSeenLastBeginsWithItsOwnFirst) {
  Programme programme(path_, writer(), false);
  programme.begin(films({"http://a", "list", "http://d"}));
  programme.keepAtOnce(mediaTime(30), kStart);
  programme.choose(1, Way::Forward);
  EXPECT_EQ(programme.spread(films({"http://b", "http://c"})), 1U);
}

}  // namespace
}  // namespace relievo
