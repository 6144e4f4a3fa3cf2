// SPDX-License-Identifier: Apache-2.0
#include "app/player/browse/shelf_view.h"

#include <algorithm>
#include <utility>

#include "app/player/screen/screen_text.h"

namespace relievo {
namespace {

// Calls `visit(section, film, top, height)` for each row from the top of the whole list down; film null: a heading.
template <class Visit>
double walk(const FilmShelf& shelf, Visit&& visit) {
  double top = 0;
  for (const ShelfSection& section : shelf.sections()) {
    if (section.films.empty()) continue;
    visit(section, nullptr, top);
    top += ScreenListRow::kHeading;
    for (const ShelfFilm& film : section.films) {
      visit(section, &film, top);
      top += ScreenListRow::kFilm;
    }
  }
  return top;
}

ScreenListRow rowOf(const ShelfFilm& film, std::size_t number, const PosterOf& poster_of) {
  ScreenListRow row{.title = film.title, .film = number};
  const auto poster = poster_of ? poster_of(film.url) : nullptr;
  const double length_s = poster ? poster->length_s : 0;
  row.detail = timesOf(film, length_s);
  if (!film.folder.empty()) row.detail += (row.detail.empty() ? "" : "   ") + film.folder;
  if (film.left_s && length_s > 0) row.left = std::clamp(*film.left_s / length_s, 0.0, 1.0);
  if (poster && !poster->empty()) row.picture = {poster, &poster->picture};
  else if (poster) row.in_poster = "cannot be read";
  return row;
}

}  // namespace

std::string timesOf(const ShelfFilm& film, double length_s) {
  std::string length = length_s > 0 ? clockTime(length_s) : "";
  if (!film.left_s) return length;
  return clockTime(*film.left_s) + (length.empty() ? "" : " of " + length);
}

ScreenList viewOf(const FilmShelf& shelf, const PosterOf& poster, const std::string& empty, double bottom) {
  const double area = bottom - ScreenList::kTop;
  ScreenList list{.rows = {}, .selected = shelf.selected(), .films = shelf.size(), .message = {}, .pointed = {}};
  if (shelf.empty()) {
    list.message = empty;
    return list;
  }
  const FilmShelf::Place place = shelf.placeInSection(shelf.selected());
  list.number = place.number, list.of = place.of;
  std::size_t number = 0;
  double middle = 0;
  const double whole = walk(shelf, [&](const ShelfSection&, const ShelfFilm* film, double top) {
    if (film != nullptr && number++ == shelf.selected()) middle = top + ScreenListRow::kFilm / 2;
  });
  const double offset = std::clamp(middle - area / 2, 0.0, std::max(0.0, whole - area));
  number = 0;
  walk(shelf, [&](const ShelfSection& section, const ShelfFilm* film, double top) {
    const double height = film == nullptr ? ScreenListRow::kHeading : ScreenListRow::kFilm;
    const std::size_t this_one = film == nullptr ? 0 : number++;
    if (top < offset || top + height > offset + area) return;
    ScreenListRow row;
    if (film != nullptr) row = rowOf(*film, this_one, poster);
    else row.title = section.name;
    row.top = ScreenList::kTop + top - offset;
    list.rows.push_back(std::move(row));
  });
  if (offset > 0) {  // without the gap that a row above them leaves
    const double gap = list.rows.front().top - ScreenList::kTop;
    for (ScreenListRow& row : list.rows) row.top -= gap;
  }
  list.before = offset / whole;
  list.shown = std::min(1.0, area / whole);
  return list;
}

}  // namespace relievo
