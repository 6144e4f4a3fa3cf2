// SPDX-License-Identifier: Apache-2.0
// Rows in columns. A long row takes several lines.
#include "app/player/screen/keys_script.h"

#include <algorithm>
#include <string>

#include "app/player/screen/fold.h"
#include "app/player/screen/screen_script.h"

namespace relievo {
namespace {

constexpr double kTop = 84, kBottom = 700;
constexpr int kLargest = 28, kSmallest = 5;  // letters
constexpr double kLine = 1.25;               // of the letters' size
constexpr double kBetween = 36;              // two columns
constexpr std::size_t kMostLines = 12;       // of a row

struct Row {
  std::vector<std::string> keys, meaning;
  [[nodiscard]] double lines() const noexcept { return static_cast<double>(std::max(keys.size(), meaning.size())); }
};

struct Page {
  double size = kSmallest;
  int columns = 1;
  double width = 0, keys = 0;  // of a column, and its part for the keys
  std::vector<Row> rows;
};

Page pageOf(const ScreenRows& rows, double width, double size, int columns) {
  Page page{.size = size, .columns = columns};
  page.width = (width - 2 * kMargin - kBetween * (columns - 1)) / columns;
  page.keys = 0.32 * page.width;
  for (const auto& [keys, meaning] : rows) {
    page.rows.push_back({folded(keys, cellsIn(page.keys - size, size), kMostLines),
                         folded(meaning, cellsIn(page.width - page.keys, size), kMostLines)});
  }
  return page;
}

// Calls `visit(row, column, top)`; how many columns it takes.
template <class Visit>
int walk(const Page& page, Visit&& visit) {
  int column = 0;
  double top = kTop;
  for (const Row& row : page.rows) {
    const double height = row.lines() * kLine * page.size;
    if (top + height > kBottom && top > kTop) {
      ++column;
      top = kTop;
    }
    visit(row, column, top);
    top += height;
  }
  return column + 1;
}

bool finds(const Page& page) {
  constexpr int kFewestCells = 8;  // see cellsIn
  const bool wide_enough = cellsIn(page.keys - page.size, page.size) > kFewestCells;
  return wide_enough && walk(page, [](const Row&, int, double) {}) <= page.columns;
}

Page largestOf(const ScreenRows& rows, double width) {
  constexpr int kMostColumns = 3;
  for (int size = kLargest; size >= kSmallest; --size) {
    for (int columns = 1; columns <= kMostColumns; ++columns) {
      Page page = pageOf(rows, width, size, columns);
      if (finds(page)) return page;
    }
  }
  return pageOf(rows, width, kSmallest, 1);
}

}  // namespace

void addKeys(Script& script, const ScreenRows& rows) {
  script.box({0, 0, script.width(), kScreenRows}, kBlack, 0.86);
  script.text("Keys", 7, kMargin, kHeadingTop, kHeadingSize);
  const Page page = largestOf(rows, script.width());
  const double line = kLine * page.size;
  walk(page, [&](const Row& row, int column, double top) {
    const double x = kMargin + column * (page.width + kBetween);
    const auto add = [&](const std::vector<std::string>& lines, double from, const char* color) {
      for (std::size_t i = 0; i < lines.size(); ++i) {
        script.text(lines[i], 7, from, top + line * static_cast<double>(i), page.size, color);
      }
    };
    add(row.keys, x, kAccent);
    add(row.meaning, x + page.keys, kWhite);
  });
}

}  // namespace relievo
