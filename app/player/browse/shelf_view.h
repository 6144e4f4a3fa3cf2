// SPDX-License-Identifier: Apache-2.0
// Converts the shelf to the rows on the screen around the selected film.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/player/browse/film_shelf.h"
#include "app/player/browse/poster.h"
#include "app/player/screen/screen_list.h"

namespace relievo {

// Null: there is none, or it is not made yet.
using PosterOf = std::function<std::shared_ptr<const Poster>(const std::string& url)>;

// The selected film is in the middle, except near the list's ends. Only whole rows are shown. `empty`: the message if
// there is no film. `bottom`: lower end of the rows. Pure.
[[nodiscard]] ScreenList viewOf(const FilmShelf& shelf, const PosterOf& poster, const std::string& empty,
                                double bottom = ScreenList::kBottom);

// "12:31 of 1:02:10", "1:02:10", "12:31" or "", depending on what is known.
[[nodiscard]] std::string timesOf(const ShelfFilm& film, double length_s);

}  // namespace relievo
