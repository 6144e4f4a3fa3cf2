// SPDX-License-Identifier: Apache-2.0
// The list of films that a viewer chooses from: sections of films, and which one is selected. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace relievo {

struct ShelfFilm {
  std::string url, depth_url;
  std::string title;
  std::string folder;            // within its place; empty: directly in it
  std::optional<double> left_s;  // where the viewer left it; nullopt: not begun, or seen to its end
  bool operator==(const ShelfFilm&) const = default;
};

struct ShelfSection {
  std::string name;  // "Recent", a folder's or a stick's
  std::vector<ShelfFilm> films;
  bool operator==(const ShelfSection&) const = default;
};

class FilmShelf {
 public:
  // Replaces the films. Afterwards the selected film is the first of these that exists: the same film in its section,
  // the film at the same place of that section, the same film in another section, the film at the same place of the
  // list.
  void put(std::vector<ShelfSection> sections);

  // The number of films, without headings; a film in two sections counts twice.
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] const std::vector<ShelfSection>& sections() const noexcept { return sections_; }
  // The index of the selected film, over all sections; 0 if there is none.
  [[nodiscard]] std::size_t selected() const noexcept { return selected_; }
  // A film's number in its section, from 1 on, and the section's number of films; `film` must be below `size`.
  struct Place {
    std::size_t number = 0, of = 0;
  };
  [[nodiscard]] Place placeInSection(std::size_t film) const noexcept;
  // `film` must be below `size`.
  [[nodiscard]] const ShelfFilm& film(std::size_t film) const noexcept;

  // Stops at both ends.
  void selectBy(std::ptrdiff_t films) noexcept;
  // Selects a film by its number; the last film if there are not so many.
  void select(std::size_t film) noexcept;

 private:
  // `there`: in that section, else in any other.
  [[nodiscard]] std::optional<std::size_t> find(const std::string& section, const std::string& url,
                                                bool there) const noexcept;
  [[nodiscard]] std::optional<std::size_t> inSection(const std::string& section, std::size_t number) const noexcept;

  std::vector<ShelfSection> sections_;
  std::size_t size_ = 0, selected_ = 0;
};

}  // namespace relievo
