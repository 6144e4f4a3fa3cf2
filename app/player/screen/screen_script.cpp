// SPDX-License-Identifier: Apache-2.0
// Boxes and words at their places.
#include "app/player/screen/screen_script.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/player/screen/fold.h"
#include "app/player/screen/list_script.h"
#include "app/player/screen/script.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kBarTop = 658, kBarHeight = 12, kBarReach = 14;  // so far above and below the bar a click is on it
constexpr double kTitleSize = 30, kTitleLine = 38, kTimesSize = 24, kTimesTop = 680;
constexpr double kGaugeTop = 280, kGaugeHeight = 200, kGaugeWidth = 16, kGaugeNewtons = 10;
constexpr double kEdge = 30;  // of the mark for a finger beside the picture
constexpr double kMostKeyRows = 24;

void addBar(Script& script, const ScreenBar& bar) {
  const double inner = script.width() - 2 * kMargin;
  const auto title = folded(bar.title, cellsIn(inner, kTitleSize), 2);
  const double title_top = kBarTop - 14 - kTitleLine * static_cast<double>(title.size());
  script.box({0, title_top - 12, script.width(), kScreenRows - title_top + 12}, kBlack, 0.6);
  for (std::size_t i = 0; i < title.size(); ++i) {
    script.text(title[i], 7, kMargin, title_top + kTitleLine * static_cast<double>(i), kTitleSize);
  }
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
  script.text(bar.times, 7, kMargin, kTimesTop, kTimesSize);
  const double half = inner * 0.55;
  const auto status = folded(bar.status, cellsIn(half, kTimesSize), 1);
  if (!status.empty()) script.text(status[0], 9, script.width() - kMargin, kTimesTop, kTimesSize, kGray);
}

void addForce(Script& script, double force_n) {
  const double x = script.width() - kMargin - kGaugeWidth;
  const double level = kGaugeHeight * std::clamp(force_n / kGaugeNewtons, 0.0, 1.0);
  script.box({x - 56, kGaugeTop - 14, kGaugeWidth + 70, kGaugeHeight + 62}, kBlack, 0.5);
  script.box({x, kGaugeTop, kGaugeWidth, kGaugeHeight}, kWhite, 0.25);
  script.box({x, kGaugeTop + kGaugeHeight - level, kGaugeWidth, level}, kAccent, 1);
  for (const int newtons : {0, 5, 10}) {
    const double y = kGaugeTop + kGaugeHeight * (1 - newtons / kGaugeNewtons);
    script.text(std::to_string(newtons), 6, x - 10, y, 20, kGray);
  }
  script.text(print("%.1f N", force_n), 9, x + kGaugeWidth + 4, kGaugeTop + kGaugeHeight + 12, 26);
}

// An arrowhead at the edge that is nearest to the finger, pointing to it.
void addFinger(Script& script, const FingerBeside& finger) {
  const double x = std::clamp(script.width() * (0.5 + finger.across), kEdge, script.width() - kEdge);
  const double y = std::clamp(kScreenRows * (0.5 - finger.up), kEdge, kScreenRows - kEdge);
  const double to_x = script.width() * (0.5 + finger.across) - x, to_y = kScreenRows * (0.5 - finger.up) - y;
  const double length = std::max(std::hypot(to_x, to_y), 1e-3);
  const double along_x = 24 * to_x / length, along_y = 24 * to_y / length;
  script.shape(print("m %.1f %.1f l %.1f %.1f %.1f %.1f", 30 + along_x, 30 + along_y, 30 - along_x - along_y,
                     30 - along_y + along_x, 30 - along_x + along_y, 30 - along_y - along_x),
               x - 30, y - 30, kAccent, 0.9);
}

void addNotice(Script& script, const ScreenNotice& notice) {
  script.text(notice.words, 7, kMargin, 30, 36);
  if (!notice.level) return;
  script.box({kMargin, 80, 300, 10}, kWhite, 0.3);
  script.box({kMargin, 80, 300 * std::clamp(*notice.level, 0.0, 1.0), 10}, kAccent, 1);
}

void addWarning(Script& script, const std::string& why, double top) {
  const auto lines = folded(why, cellsIn(script.width() - 2 * kMargin, 26), 3);
  script.box({kMargin - 14, top, script.width() - 2 * kMargin + 28, 34.0 * static_cast<double>(lines.size()) + 10},
             kBlack, 0.6);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    script.text(lines[i], 7, kMargin, top + 4 + 34.0 * static_cast<double>(i), 26, kWarn);
  }
}

void addStatistics(Script& script, const ScreenRows& rows) {
  constexpr double kTop = 160, kLine = 28, kSize = 22, kLabel = 110;
  const double width = std::min(820.0, script.width() - 2 * kMargin);
  ScreenRows lines;
  for (const auto& [label, figures] : rows) {
    std::string first = label;
    for (const std::string& line : folded(figures, cellsIn(width - kLabel, kSize), 3)) {
      lines.emplace_back(std::exchange(first, ""), line);
    }
  }
  script.box({kMargin - 14, kTop, width + 28, kLine * static_cast<double>(lines.size()) + 20}, kBlack, 0.6);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double y = kTop + 10 + kLine * static_cast<double>(i);
    script.text(lines[i].first, 7, kMargin, y, kSize, kAccent);
    script.text(lines[i].second, 7, kMargin + kLabel, y, kSize);
  }
}

void addCell(Script& script, double x, double y, double width, const std::string& words, double size,
             const char* color) {
  const auto line = folded(words, cellsIn(width, size), 1);
  if (!line.empty()) script.text(line[0], 7, x, y, size, color);
}

void addKeys(Script& script, const ScreenRows& rows) {
  const double column = (script.width() - 2 * kMargin) / 2;
  const double count = std::max(std::ceil(static_cast<double>(rows.size()) / 2), 1.0);
  const double line = std::min(34.0, 640 / std::max(count, kMostKeyRows * 0.5));
  const double size = 0.74 * line;
  script.box({0, 0, script.width(), kScreenRows}, kBlack, 0.8);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double at = static_cast<double>(i);
    const double x = kMargin + (at >= count ? column : 0);
    const double y = 40 + line * (at >= count ? at - count : at);
    const double keys = 0.36 * column;
    addCell(script, x, y, keys - 14, rows[i].first, size, kAccent);
    addCell(script, x + keys, y, column - keys - 20, rows[i].second, size, kWhite);
  }
}

}  // namespace

std::string screenHead(double aspect) {
  return print(
      "[Script Info]\nScriptType: v4.00+\nPlayResX: %.0f\nPlayResY: %.0f\nWrapStyle: 2\nScaledBorderAndShadow: yes\n"
      "[V4+ Styles]\nFormat: Name, Fontname, Fontsize, PrimaryColour, SecondaryColour, OutlineColour, BackColour, "
      "Bold, "
      "Italic, Underline, StrikeOut, ScaleX, ScaleY, Spacing, Angle, BorderStyle, Outline, Shadow, Alignment, MarginL, "
      "MarginR, MarginV, Encoding\n"
      "Style: Default,sans-serif,28,&H00FFFFFF,&H00FFFFFF,&H00000000,&H80000000,0,0,0,0,100,100,0,0,1,1.6,0,7,0,0,0,1\n"
      "[Events]\nFormat: Layer, Start, End, Style, Name, MarginL, MarginR, MarginV, Effect, Text\n",
      kScreenRows * aspect, kScreenRows);
}

std::vector<std::string> screenLines(const ScreenContent& content, double aspect) {
  Script script(kScreenRows * aspect);
  if (content.list) addList(script, *content.list);
  if (content.finger) addFinger(script, *content.finger);
  if (content.bar) addBar(script, *content.bar);
  if (content.force_n) addForce(script, *content.force_n);
  if (!content.hint.empty()) script.text(content.hint, 2, 0.5 * script.width(), 560, 32);
  if (!content.statistics.empty()) addStatistics(script, content.statistics);
  if (!content.warning.empty()) addWarning(script, content.warning, content.list ? 590 : 100);
  if (!content.keys.empty()) addKeys(script, content.keys);
  if (content.notice) addNotice(script, *content.notice);
  return script.take();
}

std::optional<double> barShareAt(double across, double down, double aspect) noexcept {
  const double x = across * kScreenRows * aspect, y = down * kScreenRows;
  const double inner = kScreenRows * aspect - 2 * kMargin;
  const bool on_it = y >= kBarTop - kBarReach && y <= kBarTop + kBarHeight + kBarReach && x >= 0.5 * kMargin &&
                     x <= inner + 1.5 * kMargin;
  if (!on_it) return std::nullopt;
  return std::clamp((x - kMargin) / inner, 0.0, 1.0);
}

}  // namespace relievo
