// SPDX-License-Identifier: Apache-2.0
#include "app/player/browse/film_shelf.h"

#include <algorithm>
#include <utility>

namespace relievo {
namespace {

// The section of a film, and the film's number in it.
std::pair<std::size_t, std::size_t> placeOf(const std::vector<ShelfSection>& sections, std::size_t film) noexcept {
  std::size_t section = 0;
  while (film >= sections[section].films.size()) film -= sections[section++].films.size();
  return {section, film};
}

}  // namespace

void FilmShelf::put(std::vector<ShelfSection> sections) {
  std::string section, url;
  if (!empty()) {
    const auto [at, number] = placeOf(sections_, selected_);
    section = sections_[at].name;
    url = sections_[at].films[number].url;
  }
  sections_ = std::move(sections);
  size_ = 0;
  for (const ShelfSection& each : sections_) size_ += each.films.size();
  select(find(section, url).value_or(selected_));
}

std::optional<std::size_t> FilmShelf::find(const std::string& section, const std::string& url) const noexcept {
  std::optional<std::size_t> elsewhere;  // in another section
  std::size_t film = 0;
  for (const ShelfSection& each : sections_) {
    for (const ShelfFilm& one : each.films) {
      if (one.url == url && each.name == section) return film;
      if (one.url == url && !elsewhere) elsewhere = film;
      ++film;
    }
  }
  return elsewhere;
}

const ShelfFilm& FilmShelf::film(std::size_t film) const noexcept {
  const auto [section, number] = placeOf(sections_, film);
  return sections_[section].films[number];
}

void FilmShelf::selectBy(std::ptrdiff_t films) noexcept {
  select(static_cast<std::size_t>(std::max<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(selected_) + films, 0)));
}

void FilmShelf::select(std::size_t film) noexcept {
  selected_ = empty() ? 0 : std::min(film, size_ - 1);
}

}  // namespace relievo
