// SPDX-License-Identifier: Apache-2.0
// The files that hold a film's painted material maps, and the time from which each applies.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"

namespace relievo {

struct Painting {
  std::string path;
  double from_s = 0;  // it is painted over the film's first picture at or after this time

  bool operator==(const Painting&) const = default;
};

// Parses "FILE", which is from 0 on, or "SECONDS=FILE,..", with times that increase. InvalidArgument with a message
// that says what is wrong.
[[nodiscard]] Result<std::vector<Painting>> parsePaintings(std::string_view word);

}  // namespace relievo
