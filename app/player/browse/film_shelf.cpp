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
  std::size_t number = 0;
  if (!empty()) {
    const auto [at, in_section] = placeOf(sections_, selected_);
    section = sections_[at].name;
    url = sections_[at].films[in_section].url;
    number = in_section;
  }
  sections_ = std::move(sections);
  size_ = 0;
  for (const ShelfSection& each : sections_) size_ += each.films.size();
  auto film = find(section, url, true);
  if (!film) film = inSection(section, number);
  if (!film) film = find(section, url, false);
  select(film.value_or(selected_));
}

// The film at that place of a section, or the section's last one.
std::optional<std::size_t> FilmShelf::inSection(const std::string& section, std::size_t number) const noexcept {
  std::size_t before = 0;
  for (const ShelfSection& each : sections_) {
    if (each.name == section && !each.films.empty()) return before + std::min(number, each.films.size() - 1);
    before += each.films.size();
  }
  return std::nullopt;
}

std::optional<std::size_t> FilmShelf::find(const std::string& section, const std::string& url,
                                           bool there) const noexcept {
  std::size_t film = 0;
  for (const ShelfSection& each : sections_) {
    for (const ShelfFilm& one : each.films) {
      if (one.url == url && (each.name == section) == there) return film;
      ++film;
    }
  }
  return std::nullopt;
}

const ShelfFilm& FilmShelf::film(std::size_t film) const noexcept {
  const auto [section, number] = placeOf(sections_, film);
  return sections_[section].films[number];
}

FilmShelf::Place FilmShelf::placeInSection(std::size_t film) const noexcept {
  const auto [section, number] = placeOf(sections_, film);
  return {.number = number + 1, .of = sections_[section].films.size()};
}

void FilmShelf::selectBy(std::ptrdiff_t films) noexcept {
  select(static_cast<std::size_t>(std::max<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(selected_) + films, 0)));
}

void FilmShelf::select(std::size_t film) noexcept {
  selected_ = empty() ? 0 : std::min(film, size_ - 1);
}

}  // namespace relievo
