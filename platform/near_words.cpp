// SPDX-License-Identifier: Apache-2.0
// One row of the table of distances is held at a time.
#include "platform/near_words.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace relievo {

std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const std::size_t changed = diagonal + (a[i - 1] == b[k - 1] ? 0 : 1);
      diagonal = row[k];
      row[k] = std::min({changed, row[k] + 1, row[k - 1] + 1});
    }
  }
  return row.back();
}

std::string nearestWord(std::string_view wanted, std::span<const std::string> words) {
  const std::string small = inSmallLetters(wanted);
  std::size_t least = leastDifference(wanted);
  std::string nearest;
  for (const std::string& word : words) {
    const std::size_t distance = editDistance(small, inSmallLetters(word));
    if (distance >= least) continue;
    least = distance;
    nearest = word;
  }
  return nearest;
}

std::string inSmallLetters(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return small;
}

}  // namespace relievo
