// SPDX-License-Identifier: Apache-2.0
// A row: the poster, beside it the title, and under that the known facts about the film.
#include "app/player/screen/list_script.h"

#include <algorithm>
#include <cmath>

#include "app/player/screen/fold.h"
#include "app/player/screen/screen_script.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr const char* kBackground = "241C18";  // blue, green, red: a dark slate
constexpr const char* kPale = "C4C4C4";
constexpr double kPosterLeft = kMargin + 10, kPosterTop = 5, kPosterWidth = 148, kPosterHeight = 83;
constexpr double kTextLeft = kPosterLeft + kPosterWidth + 24;
constexpr double kTitle = 26, kTitleLine = 31, kDetail = 22, kDetailLine = 28;
constexpr double kRail = 8;  // width of the scroll bar
constexpr double kFootTop = 680, kFootSize = 22;

double footWidth(const std::string& words) noexcept {
  return kLetterOfSize * kFootSize * static_cast<double>(words.size());
}

std::string helpWords(const std::string& help_key) {
  return help_key.empty() ? "" : help_key + ": all keys";
}

void addHeading(Script& script, const ScreenListRow& row) {
  const auto line = folded(row.title, cellsIn(script.width() - 2 * kMargin, 26), 1);
  if (!line.empty()) script.text(line[0], 7, kPosterLeft, row.top + 10, 26, kAccent);
}

void addFilm(Script& script, const ScreenListRow& row, const ScreenList& list) {
  const double right = script.width() - kMargin - 20;
  const Area whole{kMargin, row.top, right - kMargin, row.height() - 2};
  if (row.film == list.selected) {
    script.box(whole, kWhite, 0.16);
    script.box({kMargin, row.top, 6, row.height() - 2}, kAccent, 1);
  } else if (row.film == list.pointed) {
    script.box(whole, kWhite, 0.07);
  }
  script.box({kPosterLeft, row.top + kPosterTop, kPosterWidth, kPosterHeight}, kBlack, 0.6);
  script.text(row.in_poster, 5, kPosterLeft + kPosterWidth / 2, row.top + kPosterTop + kPosterHeight / 2, 19, kGray);
  const double width = right - kTextLeft - 10;
  const bool has_detail = !row.detail.empty();
  const auto title = folded(row.title, cellsIn(width, kTitle), has_detail ? 2 : 3);
  const double height = kTitleLine * static_cast<double>(title.size()) + (has_detail ? kDetailLine : 0);
  double y = row.top + 0.5 * (row.height() - 2 - height);
  for (const std::string& line : title) {
    script.text(line, 7, kTextLeft, y, kTitle);
    y += kTitleLine;
  }
  const auto detail = folded(row.detail, cellsIn(width, kDetail), 1);
  if (!detail.empty()) script.text(detail[0], 7, kTextLeft, y + 2, kDetail, kPale);
}

// Over the poster's foot: how much of the film was seen.
void addSeen(Script& script, const ScreenListRow& row) {
  const double y = row.top + kPosterTop + kPosterHeight;
  script.box({kPosterLeft, y, kPosterWidth, 4}, kWhite, 0.25);
  script.box({kPosterLeft, y, kPosterWidth * *row.left, 4}, kAccent, 1);
}

void addRail(Script& script, const ScreenList& list) {
  if (list.shown >= 1) return;
  constexpr double kHeight = ScreenList::kBottom - ScreenList::kTop;
  const double x = script.width() - kMargin - kRail;
  script.box({x, ScreenList::kTop, kRail, kHeight}, kWhite, 0.12);
  script.box({x, ScreenList::kTop + kHeight * list.before, kRail, kHeight * list.shown}, kWhite, 0.45);
}

void addFoot(Script& script, const ScreenList& list, const ListKeys& keys) {
  constexpr double kGap = 24;
  const std::string help = helpWords(keys.help), choose = "Up and down choose, " + keys.choose + " plays";
  script.text(help, 9, script.width() - kMargin, kFootTop, kFootSize, kGray);
  const bool fits = footWidth(choose) + kGap + footWidth(help) <= script.width() - 2 * kMargin;
  if (list.films > 0 && fits) script.text(choose, 7, kMargin, kFootTop, kFootSize, kGray);
}

}  // namespace

void addList(Script& script, const ScreenList& list, const ListKeys& keys) {
  script.box({0, 0, script.width(), kScreenRows}, kBackground, 1);
  script.text("Films", 7, kMargin, kHeadingTop, kHeadingSize);
  if (list.films > 0) {
    script.text(print("%zu of %zu", list.number, list.of), 9, script.width() - kMargin, 34, 24, kGray);
  }
  for (const ScreenListRow& row : list.rows) {
    if (!row.film) {
      addHeading(script, row);
      continue;
    }
    addFilm(script, row, list);
    if (row.left) addSeen(script, row);
  }
  addRail(script, list);
  const auto message = folded(list.message, cellsIn(script.width() - 2 * kMargin, 30), 4);
  for (std::size_t i = 0; i < message.size(); ++i) {
    script.text(message[i], 5, 0.5 * script.width(), 340 + 40.0 * static_cast<double>(i), 30);
  }
  addFoot(script, list, keys);
}

// Each in the middle of its place, in its own shape.
std::vector<TextPicture> postersOf(const ScreenList& list, const TextFrame& frame) {
  const double down = frame.height / kScreenRows, across = frame.width / (kScreenRows * frame.aspect);
  std::vector<TextPicture> posters;
  for (const ScreenListRow& row : list.rows) {
    if (row.picture == nullptr || row.picture->cols < 1 || row.picture->rows < 1) continue;
    TextPicture poster = *row.picture;
    const double scale = std::min(kPosterWidth / poster.cols, kPosterHeight / poster.rows);
    const double width = poster.cols * scale, height = poster.rows * scale;
    poster.x = static_cast<int>(std::lround((kPosterLeft + 0.5 * (kPosterWidth - width)) * across));
    poster.y = static_cast<int>(std::lround((row.top + kPosterTop + 0.5 * (kPosterHeight - height)) * down));
    poster.width = static_cast<int>(std::lround(width * across));
    poster.height = static_cast<int>(std::lround(height * down));
    posters.push_back(std::move(poster));
  }
  return posters;
}

std::optional<std::size_t> listFilmAt(const ScreenList& list, double across, double down, double aspect) noexcept {
  const double x = across * kScreenRows * aspect, y = down * kScreenRows;
  if (x < kMargin || x > kScreenRows * aspect - kMargin) return std::nullopt;
  for (const ScreenListRow& row : list.rows) {
    if (row.film && y >= row.top && y < row.top + row.height()) return row.film;
  }
  return std::nullopt;
}

bool isListHelpAt(const std::string& help_key, double across, double down, double aspect) {
  const double right = kScreenRows * aspect - kMargin, x = across * kScreenRows * aspect, y = down * kScreenRows;
  return !help_key.empty() && x >= right - footWidth(helpWords(help_key)) && x <= right && y >= kFootTop;
}

}  // namespace relievo
