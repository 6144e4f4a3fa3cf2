// SPDX-License-Identifier: Apache-2.0
// The stereo matchers that measureStereo compares.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/lab/film/view_film.h"

namespace relievo {

inline constexpr const char* kAuthors = "author";  // the name of relievo-author's matcher

// Returns the depth of one pair of views. A matcher may use the pairs that it was given before.
using Matcher = std::function<Frame(const Frame& left, const Frame& right)>;

struct Contestant {
  std::string name;
  int quick_cols = 0;  // columns that the player's matcher compares; 0: not the player's matcher

  [[nodiscard]] Matcher make(const ViewFilmFormat& format) const;
};

// All matchers for this film. The player's matcher is left out at sizes larger than the views.
[[nodiscard]] std::vector<Contestant> contestantsOn(const ViewFilmFormat& film);

}  // namespace relievo
