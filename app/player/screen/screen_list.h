// SPDX-License-Identifier: Apache-2.0
// The part of the list of films that is on the screen: what its rows say and where they are.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/render/text/text_picture.h"

namespace relievo {

// Lengths are in the screen script's units: the view is 720 high (screen_script.h).
struct ScreenListRow {
  static constexpr double kFilm = 96, kHeading = 46;  // heights

  std::string title;
  std::string detail;               // "12:31 of 1:02:10   Holidays"
  std::optional<std::size_t> film;  // its number on the shelf; nullopt: a heading
  double top = 0;
  std::optional<double> left;                  // how much of it was seen, 0 to 1
  std::shared_ptr<const TextPicture> picture;  // null: none
  std::string in_poster;                       // in place of a picture: why there is none
  [[nodiscard]] double height() const noexcept { return film ? kFilm : kHeading; }
  bool operator==(const ScreenListRow&) const = default;
};

struct ScreenList {
  static constexpr double kTop = 80, kBottom = 664;  // of the rows
  static constexpr double kBottomOverWarning = 560;  // likewise, while a warning stands below them

  std::vector<ScreenListRow> rows;  // those that find room, from the top down
  std::size_t selected = 0, films = 0;
  std::size_t number = 0, of = 0;      // of the selected film in its section, from 1 on, and how many films that has
  double before = 0, shown = 1;        // of the whole list: what lies above the rows, and the rows, in shares
  std::string message;                 // in place of rows
  std::optional<std::size_t> pointed;  // the film that the mouse is over
  bool operator==(const ScreenList&) const = default;
};

}  // namespace relievo
