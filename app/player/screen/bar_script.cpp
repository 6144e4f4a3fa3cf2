// SPDX-License-Identifier: Apache-2.0
// Places the bar, the words around it, and a point of the view on it.
#include "app/player/screen/bar_script.h"

#include <algorithm>
#include <string>
#include <vector>

#include "app/player/screen/fold.h"

namespace relievo {
namespace {

constexpr double kBarTop = 658, kBarHeight = 12, kBarReach = 14;  // so far above and below the bar a click is on it
constexpr double kTitleSize = 30, kTitleLine = 38, kTimesSize = 24, kTimesTop = 680, kStatusLine = 30;
constexpr double kPointedSize = 20, kPointedTop = kBarTop - 34;  // the time that the mouse points at

// Drops the last parts that do not fit.
std::string shortened(std::string parts, int cells) {
  for (std::size_t end = parts.rfind("   "); static_cast<int>(parts.size()) > cells && end != std::string::npos;
       end = parts.rfind("   ")) {
    parts.resize(end);
  }
  return parts;
}

// The words around the bar.
struct BarWords {
  std::vector<std::string> title, status;  // above it
  std::string times, beside;               // below it; at the right the status, where there is room for all of it

  // Where the dark ground behind all of them begins.
  [[nodiscard]] double top() const noexcept {
    return kPointedTop - 16 - kTitleLine * static_cast<double>(title.size()) -
           kStatusLine * static_cast<double>(status.size());
  }
};

BarWords wordsOf(const ScreenBar& bar, double width) {
  constexpr std::size_t kMostLines = 3;  // above the bar
  const double inner = width - 2 * kMargin;
  const int cells = cellsIn(inner, kTimesSize);
  BarWords words{.title = folded(bar.title, cellsIn(inner, kTitleSize), 2)};
  if (const auto times = folded(shortened(bar.times, cells), cells, 1); !times.empty()) words.times = times[0];
  if (words.times.size() + 2 + bar.status.size() <= static_cast<std::size_t>(cells)) {
    words.beside = bar.status;
    return words;
  }
  const std::size_t lines = kMostLines - words.title.size();
  words.status = folded(lines == 1 ? shortened(bar.status, cells) : bar.status, cells, lines);
  return words;
}

// The time that the mouse points at, above the bar and centred on the mouse.
void addPointed(Script& script, const ScreenBar& bar) {
  if (!bar.pointed) return;
  const double inner = script.width() - 2 * kMargin;
  constexpr double kHalf = 40;  // of the widest time
  const double x = std::clamp(kMargin + inner * *bar.pointed, kHalf, script.width() - kHalf);
  script.text(bar.pointed_time, 8, x, kPointedTop, kPointedSize, kAccent);
}

void addBarWords(Script& script, const BarWords& words) {
  double y = words.top() + 12;
  for (const std::string& line : words.title) {
    script.text(line, 7, kMargin, y, kTitleSize);
    y += kTitleLine;
  }
  for (const std::string& line : words.status) {
    script.text(line, 7, kMargin, y, kTimesSize, kGray);
    y += kStatusLine;
  }
  script.text(words.times, 7, kMargin, kTimesTop, kTimesSize);
  script.text(words.beside, 9, script.width() - kMargin, kTimesTop, kTimesSize, kGray);
}

}  // namespace

double filmRows(double aspect) noexcept {
  return kScreenRows / std::min(aspect, 1.0);
}

void addBar(Script& script, const ScreenBar& bar) {
  const double inner = script.width() - 2 * kMargin;
  const BarWords words = wordsOf(bar, script.width());
  script.beginAt(script.rows() - kScreenRows);
  script.box({0, words.top(), script.width(), kScreenRows - words.top()}, kBlack, 0.6);
  addPointed(script, bar);
  addBarWords(script, words);
  if (bar.has_length) {
    script.box({kMargin, kBarTop, inner, kBarHeight}, kWhite, 0.25);
    script.box({kMargin, kBarTop, inner * bar.buffered, kBarHeight}, kWhite, 0.3);
    script.box({kMargin, kBarTop, inner * bar.position, kBarHeight}, kAccent, 1);
    for (const double chapter : bar.chapters) {
      if (chapter > 0) script.box({kMargin + inner * chapter - 1, kBarTop - 4, 3, kBarHeight + 8}, kWhite, 0.9);
    }
    for (const auto& end : {bar.loop_from, bar.loop_to}) {
      if (end) script.box({kMargin + inner * *end - 2, kBarTop - 8, 4, kBarHeight + 16}, kAccent, 1);
    }
    script.box({kMargin + inner * bar.position - 3, kBarTop - 5, 6, kBarHeight + 10}, kWhite, 1);
  }
  script.beginAt(0);
}

double roomForWords(const ScreenContent& content, double aspect) {
  if (!content.bar) return 1;
  const double rows = filmRows(aspect);
  return 1 - (kScreenRows - wordsOf(*content.bar, rows * aspect).top()) / rows;
}

std::optional<double> barShareAt(double across, double down, double aspect) noexcept {
  const double width = filmRows(aspect) * aspect;
  const double x = across * width, y = kScreenRows - (1 - down) * filmRows(aspect);
  const bool on_it = y >= kBarTop - kBarReach && y <= kBarTop + kBarHeight + kBarReach && x >= 0.5 * kMargin &&
                     x <= width - 0.5 * kMargin;
  return on_it ? std::optional(barShareAlong(across, aspect)) : std::nullopt;
}

double barShareAlong(double across, double aspect) noexcept {
  const double width = filmRows(aspect) * aspect;
  return std::clamp((across * width - kMargin) / (width - 2 * kMargin), 0.0, 1.0);
}

}  // namespace relievo
