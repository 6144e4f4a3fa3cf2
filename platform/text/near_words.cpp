// SPDX-License-Identifier: Apache-2.0
// Three rows of the table of distances are held at a time.
#include "platform/text/near_words.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "platform/text/lower_case.h"

namespace relievo {

std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, above(b.size() + 1), row;  // the rows of the last two letters of `a`, and this one
  std::iota(above.begin(), above.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row.assign(1, i);
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const std::size_t changed = above[k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1);
      row.push_back(std::min({changed, above[k] + 1, row[k - 1] + 1}));
      const bool swapped = i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1];
      if (swapped) row[k] = std::min(row[k], before[k - 2] + 1);
    }
    before = std::exchange(above, row);
  }
  return above.back();
}

namespace {

// Of a word that was broken off, as `--vol`; empty if it has under three letters, or several begin so.
std::string onlyWordThatBegins(const std::string& small, std::span<const std::string> words) {
  const auto begins = [&](const std::string& word) { return lowerCase(word).starts_with(small); };
  const std::size_t letters = small.size() - std::min(small.size(), small.find_first_not_of('-'));
  if (letters < 3 || std::ranges::count_if(words, begins) != 1) return "";
  return *std::ranges::find_if(words, begins);
}

}  // namespace

std::string nearestWord(std::string_view wanted, std::span<const std::string> words) {
  const std::string small = lowerCase(wanted);
  std::size_t least = leastDifference(wanted);
  std::string nearest;
  for (const std::string& word : words) {
    const std::size_t distance = editDistance(small, lowerCase(word));
    if (distance >= least) continue;
    least = distance;
    nearest = word;
  }
  return nearest.empty() ? onlyWordThatBegins(small, words) : nearest;
}

}  // namespace relievo
