// SPDX-License-Identifier: Apache-2.0
#include "app/author/material/painting.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace relievo {
namespace {

std::optional<Painting> timed(std::string_view item) {
  Painting painting;
  const auto [after, error] = std::from_chars(item.data(), item.data() + item.size(), painting.from_s);
  if (error != std::errc{} || !std::isfinite(painting.from_s) || painting.from_s < 0) return std::nullopt;
  item.remove_prefix(static_cast<std::size_t>(after - item.data()));
  if (item.size() < 2 || item.front() != '=') return std::nullopt;
  painting.path = item.substr(1);
  return painting;
}

}  // namespace

Result<std::vector<Painting>> parsePaintings(std::string_view word) {
  if (word.find('=') == std::string_view::npos) return std::vector{Painting{.path = std::string(word)}};
  std::vector<Painting> paintings;
  for (std::size_t at = 0; at <= word.size();) {
    const std::size_t comma = std::min(word.find(',', at), word.size());
    auto painting = timed(word.substr(at, comma - at));
    if (!painting)
      return fail(ErrorCode::InvalidArgument, "give SECONDS=FILE for each painting, such as 0=a.png,12.5=b.png");
    if (!paintings.empty() && painting->from_s <= paintings.back().from_s) {
      return fail(ErrorCode::InvalidArgument, "the times of paintings must increase; give the earliest first");
    }
    paintings.push_back(std::move(*painting));
    at = comma + 1;
  }
  return paintings;
}

}  // namespace relievo
