// SPDX-License-Identifier: Apache-2.0
// The stereo matchers that measureStereo compares.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/lab/film/view_film.h"

namespace relievo {

inline constexpr const char* kAuthors = "author";  // the name of relievo-author's matcher

// The depth of one pair of views, and the processor's time that matching them took.
struct MatchedPair {
  Frame depth;
  double ms = 0;
};

// A matcher may use the pairs that it was given before.
using Matcher = std::function<MatchedPair(const Frame& left, const Frame& right)>;

struct Contestant {
  std::string name;
  int quick_cols = 0;  // columns that the player's matcher compares; 0: not the player's matcher

  [[nodiscard]] Matcher make(const ViewFilmFormat& format) const;
};

// All matchers for this film. The player's matcher is left out at sizes larger than the views.
[[nodiscard]] std::vector<Contestant> contestantsOn(const ViewFilmFormat& film);

}  // namespace relievo
