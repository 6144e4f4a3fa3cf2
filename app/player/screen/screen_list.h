// SPDX-License-Identifier: Apache-2.0
// The visible part of the list of films: the text of its rows and their positions.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/render/text/text_picture.h"

namespace relievo {

// Lengths in units of the screen script: the view is 720 high (screen_script.h).
struct ScreenListRow {
  static constexpr double kFilm = 96, kHeading = 46;  // heights

  std::string title;
  std::string detail;               // "12:31 of 1:02:10   Holidays"
  std::optional<std::size_t> film;  // its number on the shelf; nullopt: a heading
  double top = 0;
  std::optional<double> left;                  // share that was seen, 0 to 1
  std::shared_ptr<const TextPicture> picture;  // null: none
  std::string in_poster;                       // instead of a picture: why there is none
  [[nodiscard]] double height() const noexcept { return film ? kFilm : kHeading; }
  bool operator==(const ScreenListRow&) const = default;
};

struct ScreenList {
  static constexpr double kTop = 80, kBottom = 664;  // of the rows
  static constexpr double kBottomOverWarning = 560;  // likewise, while a warning stands below them

  std::vector<ScreenListRow> rows;  // those that fit, from the top down
  std::size_t selected = 0, films = 0;
  std::size_t number = 0, of = 0;      // of the selected film in its section, from 1 on, and how many films that has
  double before = 0, shown = 1;        // shares of the whole list: above the rows, and in the rows
  std::string message;                 // in place of rows
  std::optional<std::size_t> pointed;  // the film that the mouse is over
  bool operator==(const ScreenList&) const = default;
};

}  // namespace relievo
