// SPDX-License-Identifier: Apache-2.0
// Places the bar, the words around it, and a point of the view on it.
#include "app/player/screen/bar_script.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "app/player/screen/fold.h"

namespace relievo {
namespace {

constexpr double kBarTop = 658, kBarHeight = 12, kBarReach = 14;  // so far above and below the bar a click is on it
constexpr double kTitleSize = 30, kTitleLine = 38, kTimesSize = 24, kTimesTop = 680, kStatusLine = 30;
constexpr double kButtonHeight = 34, kButtonLine = 42, kButtonSides = 14, kButtonsApart = 8;
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
  std::vector<Area> buttons;               // at the right, beside the title's last line where there is room for both
  double button_lines = 0;                 // of their own, below title and status

  // Where the dark ground behind all of them begins.
  [[nodiscard]] double top() const noexcept {
    return kPointedTop - 16 - kTitleLine * static_cast<double>(title.size()) -
           kStatusLine * static_cast<double>(status.size()) - kButtonLine * button_lines;
  }
};

// That of the longest word that it can have, so that no button moves when one is clicked.
double widthOf(const ScreenButton& button) noexcept {
  constexpr std::string_view kPause = "Pause", kFullScreen = "Full screen";
  const std::size_t most = button.verb == PlayerVerb::PlayPause    ? kPause.size()
                           : button.verb == PlayerVerb::FullScreen ? kFullScreen.size()
                                                                   : button.word.size();
  return 2 * kButtonSides + kLetterOfSize * kTimesSize * static_cast<double>(most);
}

// In lines from the right; the lowest one is at 0.
std::vector<Area> placesOf(const std::vector<ScreenButton>& buttons, double width) {
  std::vector<Area> places(buttons.size());
  double right = width - kMargin, y = 0;
  for (std::size_t i = buttons.size(); i-- > 0;) {
    const double wide = widthOf(buttons[i]);
    if (right - wide < kMargin && right < width - kMargin) {
      right = width - kMargin;
      y -= kButtonLine;
    }
    places[i] = {right - wide, y, wide, kButtonHeight};
    right -= wide + kButtonsApart;
  }
  return places;
}

// Below the title and the status, unless there is room beside the whole title.
void placeButtons(BarWords& words, const ScreenBar& bar, double width) {
  constexpr double kGap = 24;
  double title_width = width - 2 * kMargin;
  words.buttons = placesOf(bar.buttons, width);
  if (!words.buttons.empty()) {
    const double left = words.buttons.front().x - kGap - kMargin;
    const double title = kLetterOfSize * kTitleSize * static_cast<double>(bar.title.size());
    const bool beside = words.buttons.front().y == 0 && title <= left && !bar.title.empty();
    if (beside) title_width = left;
    else words.button_lines = 1 - words.buttons.front().y / kButtonLine;
  }
  words.title = folded(bar.title, cellsIn(title_width, kTitleSize), 2);
}

BarWords wordsOf(const ScreenBar& bar, double width) {
  constexpr std::size_t kMostLines = 3;  // of title and status
  const double inner = width - 2 * kMargin;
  const int cells = cellsIn(inner, kTimesSize);
  BarWords words;
  placeButtons(words, bar, width);
  if (const auto times = folded(shortened(bar.times, cells), cells, 1); !times.empty()) words.times = times[0];
  if (words.times.size() + 2 + bar.status.size() <= static_cast<std::size_t>(cells)) {
    words.beside = bar.status;
  } else {
    const std::size_t lines = kMostLines - words.title.size();
    words.status = folded(lines == 1 ? shortened(bar.status, cells) : bar.status, cells, lines);
  }
  const double lowest = words.button_lines > 0
                            ? kPointedTop - 6 - kButtonHeight
                            : words.top() + 10 + kTitleLine * (static_cast<double>(words.title.size()) - 1);
  for (Area& place : words.buttons) place.y += lowest;
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

void addBarWords(Script& script, const ScreenBar& bar, const BarWords& words) {
  double y = words.top() + 12;
  for (const std::string& line : words.title) {
    script.text(line, 7, kMargin, y, kTitleSize);
    y += kTitleLine;
  }
  for (const std::string& line : words.status) {
    script.text(line, 7, kMargin, y, kTimesSize, kGray);
    y += kStatusLine;
  }
  for (std::size_t i = 0; i < bar.buttons.size(); ++i) {
    const Area& at = words.buttons[i];
    const bool pointed = bar.buttons[i].verb == bar.pointed_button;
    script.box(at, kWhite, pointed ? 0.35 : 0.18);
    script.text(bar.buttons[i].word, 8, at.x + 0.5 * at.width, at.y + 4, kTimesSize, pointed ? kAccent : kWhite);
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
  addBarWords(script, bar, words);
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

std::optional<PlayerVerb> barButtonAt(const ScreenBar& bar, double across, double down, double aspect) {
  const double width = filmRows(aspect) * aspect;
  const double x = across * width, y = kScreenRows - (1 - down) * filmRows(aspect);
  const std::vector<Area> places = wordsOf(bar, width).buttons;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Area& at = places[i];
    if (x >= at.x && x < at.x + at.width && y >= at.y && y < at.y + at.height) return bar.buttons[i].verb;
  }
  return std::nullopt;
}

double barShareAlong(double across, double aspect) noexcept {
  const double width = filmRows(aspect) * aspect;
  return std::clamp((across * width - kMargin) / (width - 2 * kMargin), 0.0, 1.0);
}

}  // namespace relievo
