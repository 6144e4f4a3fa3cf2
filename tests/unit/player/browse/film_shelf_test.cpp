// SPDX-License-Identifier: Apache-2.0
// The list of films: what is selected, and which rows are on the screen.
#include "app/player/browse/film_shelf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/player/browse/shelf_view.h"

namespace relievo {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

ShelfFilm film(const std::string& name) {
  return {.url = "/v/" + name, .depth_url = "", .title = name, .folder = "", .left_s = {}};
}

std::vector<ShelfSection> sections(const std::string& first, int films) {
  std::vector<ShelfSection> all{{"Recent", {film(first)}}, {"Videos", {}}};
  for (int k = 0; k < films; ++k) all[1].films.push_back(film("f" + std::to_string(k)));
  return all;
}

TEST(FilmShelf, SelectionStopsAtBothEnds) {
  FilmShelf shelf;
  shelf.selectBy(1);
  EXPECT_EQ(shelf.selected(), 0u) << "without films";
  shelf.put(sections("f2", 3));
  ASSERT_EQ(shelf.size(), 4u);
  shelf.selectBy(-1);
  EXPECT_EQ(shelf.selected(), 0u);
  shelf.selectBy(2);
  EXPECT_EQ(shelf.film(shelf.selected()).title, "f1");
  shelf.selectBy(5);
  EXPECT_EQ(shelf.selected(), 3u);
  shelf.select(100);
  EXPECT_EQ(shelf.film(shelf.selected()).title, "f2");
}

TEST(FilmShelf, AFilmIsCountedInItsSection) {
  FilmShelf shelf;
  shelf.put(sections("f2", 3));
  const auto recent = shelf.placeInSection(0), last = shelf.placeInSection(3);
  EXPECT_EQ(std::pair(recent.number, recent.of), std::pair(std::size_t{1}, std::size_t{1}));
  EXPECT_EQ(std::pair(last.number, last.of), std::pair(std::size_t{3}, std::size_t{3}));
  shelf.select(2);
  const ScreenList view = viewOf(shelf, {}, "", ScreenList::kBottom);
  EXPECT_EQ(std::pair(view.number, view.of), std::pair(std::size_t{2}, std::size_t{3})) << "f1 of the videos";
}

TEST(FilmShelf, TheSelectedFilmStaysSelectedWhenOthersComeAndGo) {
  FilmShelf shelf;
  shelf.put(sections("f2", 3));
  shelf.select(3);  // f2 among the videos, not the recent one
  auto more = sections("f2", 3);
  more[1].films.insert(more[1].films.begin(), film("a"));
  shelf.put(more);
  EXPECT_EQ(shelf.selected(), 4u);
  shelf.put({{"Videos", {film("a"), film("f2")}}});
  EXPECT_EQ(shelf.selected(), 1u);
  shelf.put({{"Videos", {film("a"), film("b"), film("c")}}});
  EXPECT_EQ(shelf.selected(), 1u) << "it has gone: the one at its place";
  shelf.put({});
  EXPECT_EQ(shelf.selected(), 0u);
  EXPECT_TRUE(shelf.empty());
}

// What was seen to its end is no longer among the recent ones: the row stays, not the film.
TEST(FilmShelf, TheRowStaysSelectedWhenItsFilmLeavesTheSection) {
  FilmShelf shelf;
  const std::vector<ShelfFilm> videos{film("a"), film("b"), film("c"), film("d")};
  shelf.put({{"Recent", {film("d"), film("c"), film("b")}}, {"Videos", videos}});
  shelf.select(1);
  shelf.put({{"Recent", {film("d"), film("b")}}, {"Videos", videos}});
  EXPECT_EQ(shelf.selected(), 1u);
  EXPECT_EQ(shelf.film(1).title, "b");
  shelf.put({{"Recent", {film("d")}}, {"Videos", videos}});
  EXPECT_EQ(shelf.selected(), 0u) << "the section's last row";
  shelf.put({{"Videos", videos}});
  EXPECT_EQ(shelf.film(shelf.selected()).title, "d") << "the section has gone: the film in its folder";
}

TEST(ShelfView, TellsWhereAFilmWasLeft) {
  ShelfFilm one = film("a");
  EXPECT_EQ(timesOf(one, 0), "");
  EXPECT_EQ(timesOf(one, 3730), "1:02:10");
  one.left_s = 751;
  EXPECT_EQ(timesOf(one, 3730), "12:31 of 1:02:10");
  EXPECT_EQ(timesOf(one, 0), "12:31");
}

// A heading is 46 high, a film 96; there are 584 for them.
TEST(ShelfView, ShowsTheRowsAroundTheSelectedFilm) {
  FilmShelf shelf;
  shelf.put(sections("f2", 20));
  const ScreenList top = viewOf(shelf, {}, "");
  ASSERT_THAT(top.rows, SizeIs(7));  // 46 + 96 + 46 + 4 * 96 = 572; a fifth video would end at 668
  EXPECT_FALSE(top.rows[0].film);
  EXPECT_EQ(top.rows[0].title, "Recent");
  EXPECT_EQ(top.rows[1].film, 0u);
  EXPECT_DOUBLE_EQ(top.rows[1].top, ScreenList::kTop + 46);
  EXPECT_EQ(top.before, 0);

  shelf.select(10);
  const ScreenList middle = viewOf(shelf, {}, "");
  ASSERT_THAT(middle.rows, testing::Not(IsEmpty()));
  EXPECT_EQ(middle.rows.front().top, ScreenList::kTop);
  std::size_t selected_rows = 0;
  for (const ScreenListRow& row : middle.rows) {
    EXPECT_LE(row.top + row.height(), ScreenList::kBottom);
    if (row.film == shelf.selected()) ++selected_rows;
  }
  EXPECT_EQ(selected_rows, 1u);
  EXPECT_GT(middle.before, 0);

  shelf.select(20);
  const ScreenList end = viewOf(shelf, {}, "");
  EXPECT_EQ(end.rows.back().film, 20u);
  EXPECT_NEAR(end.before + end.shown, 1, 1e-9);
}

TEST(ShelfView, EverySelectedFilmIsOnTheScreen) {
  FilmShelf shelf;
  shelf.put(sections("f2", 40));
  for (std::size_t k = 0; k < shelf.size(); ++k) {
    shelf.select(k);
    const ScreenList list = viewOf(shelf, {}, "");
    EXPECT_EQ(std::ranges::count(list.rows, std::optional(k), &ScreenListRow::film), 1) << k;
  }
}

// A warning is shown below the rows, and the selected film is still among them.
TEST(ShelfView, AWarningHidesNoRow) {
  FilmShelf shelf;
  shelf.put(sections("f2", 40));
  for (const std::size_t k : {0U, 3U, 20U, 40U}) {
    shelf.select(k);
    const ScreenList list = viewOf(shelf, {}, "", ScreenList::kBottomOverWarning);
    EXPECT_EQ(std::ranges::count(list.rows, std::optional(k), &ScreenListRow::film), 1) << k;
    for (const ScreenListRow& row : list.rows) EXPECT_LE(row.top + row.height(), ScreenList::kBottomOverWarning);
  }
}

TEST(ShelfView, ARowHasItsPosterAndHowMuchWasSeen) {
  FilmShelf shelf;
  ShelfFilm left = film("a");
  left.left_s = 30;
  left.folder = "Holidays";
  shelf.put({{"Videos", {left, film("b"), film("broken")}}});
  auto poster = std::make_shared<Poster>();
  poster->length_s = 120;
  poster->picture = {0, 0, 1, 1, 1, 1, {1, 2, 3, 255}};
  const auto none = std::make_shared<Poster>();
  const auto poster_of = [&](const std::string& url) {
    return url == "/v/a" ? poster : url == "/v/broken" ? none : nullptr;
  };
  const ScreenList list = viewOf(shelf, poster_of, "");
  ASSERT_THAT(list.rows, SizeIs(4));
  EXPECT_EQ(list.rows[1].detail, "0:30 of 2:00   Holidays");
  EXPECT_DOUBLE_EQ(list.rows[1].left.value_or(0), 0.25);
  EXPECT_EQ(list.rows[1].picture.get(), &poster->picture);
  EXPECT_EQ(list.rows[2].picture, nullptr);
  EXPECT_EQ(list.rows[2].in_poster, "") << "not yet";
  EXPECT_EQ(list.rows[3].in_poster, "cannot be read");
}

TEST(ShelfView, WithoutFilmsItSaysSo) {
  const ScreenList list = viewOf({}, {}, "No films yet");
  EXPECT_THAT(list.rows, IsEmpty());
  EXPECT_EQ(list.message, "No films yet");
}

}  // namespace
}  // namespace relievo
