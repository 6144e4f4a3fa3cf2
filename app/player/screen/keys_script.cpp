// SPDX-License-Identifier: Apache-2.0
// Rows in columns, columns in pages. A long row takes several lines.
#include "app/player/screen/keys_script.h"

#include <algorithm>
#include <string>
#include <utility>

#include "app/player/screen/fold.h"
#include "app/player/screen/screen_script.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kTop = 84, kBottom = 700;
constexpr int kLargest = 28, kSmallest = 5;          // letters
constexpr double kLegiblePixels = 11, kHugest = 40;  // likewise, in a view of few pixels
constexpr double kLine = 1.25;                       // of the letters' size
constexpr double kBetween = 36;                      // two columns
constexpr double kKeyLetters = 7.6;                  // letter sizes: the width of the keys
constexpr int kMostColumns = 3;
constexpr std::size_t kMostLines = 12;  // of a row

struct Row {
  std::vector<std::string> keys, meaning;
  [[nodiscard]] double lines() const noexcept { return static_cast<double>(std::max(keys.size(), meaning.size())); }
};

struct Layout {
  double size = kSmallest;
  int columns = 1;
  double bottom = kBottom;
  double width = 0, keys = 0;  // of a column, and its part for the keys
  std::vector<Row> rows;
};

Layout layoutOf(const ScreenRows& rows, double width, double size, int columns) {
  Layout layout{.size = size, .columns = columns};
  layout.width = (width - 2 * kMargin - kBetween * (columns - 1)) / columns;
  // As wide as "Backspace" where that leaves half for the meaning.
  layout.keys = std::max(0.32 * layout.width, std::min(0.46 * layout.width, kKeyLetters * size));
  for (const auto& [keys, meaning] : rows) {
    layout.rows.push_back({folded(keys, cellsIn(layout.keys - size, size), kMostLines),
                           folded(meaning, cellsIn(layout.width - layout.keys, size), kMostLines)});
  }
  return layout;
}

// Calls `visit(row, column, top)`, with columns counted over all pages; how many there are.
template <class Visit>
int walk(const Layout& layout, Visit&& visit) {
  int column = 0;
  double top = kTop;
  for (const Row& row : layout.rows) {
    const double height = row.lines() * kLine * layout.size;
    if (top + height > layout.bottom && top > kTop) {
      ++column;
      top = kTop;
    }
    visit(row, column, top);
    top += height;
  }
  return column + 1;
}

int pagesOf(const Layout& layout) {
  const int columns = walk(layout, [](const Row&, int, double) {});
  return (columns + layout.columns - 1) / layout.columns;
}

bool isWideEnough(const Layout& layout) {
  constexpr int kFewestCells = 8;  // see cellsIn
  return cellsIn(layout.keys - layout.size, layout.size) > kFewestCells;
}

// The letters no smaller than this; a line at the foot says which page it is.
Layout inPages(const ScreenRows& rows, double width, double size) {
  const auto made = [&](int columns) {
    Layout layout = layoutOf(rows, width, size, columns);
    layout.bottom = kBottom - 1.6 * size;
    return layout;
  };
  Layout best = made(1);
  for (int columns = 2; columns <= kMostColumns; ++columns) {
    Layout layout = made(columns);
    if (isWideEnough(layout) && pagesOf(layout) < pagesOf(best)) best = std::move(layout);
  }
  return best;
}

Layout largestOf(const ScreenRows& rows, double width, int view_height) {
  const double legible = view_height > 0 ? kLegiblePixels * kScreenRows / view_height : kSmallest;
  for (int size = kLargest; size >= std::max<double>(kSmallest, legible); --size) {
    for (int columns = 1; columns <= kMostColumns; ++columns) {
      Layout layout = layoutOf(rows, width, size, columns);
      if (isWideEnough(layout) && pagesOf(layout) == 1) return layout;
    }
  }
  return inPages(rows, width, std::clamp<double>(legible, kSmallest, kHugest));
}

}  // namespace

std::size_t keyPages(const ScreenRows& rows, double aspect, int view_height) {
  return static_cast<std::size_t>(pagesOf(largestOf(rows, kScreenRows * aspect, view_height)));
}

void addKeys(Script& script, const KeysView& view) {
  script.box({0, 0, script.width(), kScreenRows}, kBlack, 0.86);
  script.text("Keys", 7, kMargin, kHeadingTop, kHeadingSize);
  const Layout layout = largestOf(view.rows, script.width(), view.view_height);
  const int pages = pagesOf(layout);
  const int page = std::min(static_cast<int>(view.page), pages - 1);
  const double line = kLine * layout.size;
  walk(layout, [&](const Row& row, int column, double top) {
    if (column / layout.columns != page) return;
    const double x = kMargin + (column % layout.columns) * (layout.width + kBetween);
    const auto add = [&](const std::vector<std::string>& lines, double from, const char* color) {
      for (std::size_t i = 0; i < lines.size(); ++i) {
        script.text(lines[i], 7, from, top + line * static_cast<double>(i), layout.size, color);
      }
    };
    add(row.keys, x, kAccent);
    add(row.meaning, x + layout.keys, kWhite);
  });
  if (pages == 1) return;
  const std::string turns = page + 1 < pages ? view.help_key + ": next page" : view.help_key + ": back to the film";
  script.text(print("%d of %d   ", page + 1, pages) + (view.help_key.empty() ? "" : turns), 1, kMargin, kScreenRows - 8,
              layout.size, kGray);
}

}  // namespace relievo
