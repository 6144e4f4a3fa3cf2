// SPDX-License-Identifier: Apache-2.0
// What a misspelt word was meant to be.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace relievo {

// The number of letters to insert, delete or change, or of neighbours to swap (Damerau 1964).
[[nodiscard]] std::size_t editDistance(std::string_view a, std::string_view b);
// A word is near `wanted` if its distance is below this. The dashes of an option are no letters.
[[nodiscard]] constexpr std::size_t leastDifference(std::string_view wanted) noexcept {
  const std::size_t dashes = wanted.find_first_not_of('-');
  return (wanted.size() - (dashes < wanted.size() ? dashes : 0)) / 3 + 1;
}
// The nearest of `words`, without regard to case, or the only one that begins so; empty if there is none.
[[nodiscard]] std::string nearestWord(std::string_view wanted, std::span<const std::string> words);

}  // namespace relievo
