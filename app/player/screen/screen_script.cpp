// SPDX-License-Identifier: Apache-2.0
// Places boxes and words.
#include "app/player/screen/screen_script.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/player/screen/bar_script.h"
#include "app/player/screen/fold.h"
#include "app/player/screen/keys_script.h"
#include "app/player/screen/list_script.h"
#include "app/player/screen/script.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kGaugeTop = 280, kGaugeHeight = 200, kGaugeWidth = 16, kGaugeNewtons = 10;
constexpr double kEdge = 30;  // of the mark for a finger beside the picture
constexpr double kTop = 30;   // of the text at the top of the view
constexpr double kGap = 10;   // between two of its parts

// One scale; a column and a figure for each finger that has a device. All above `bottom`.
void addForces(Script& script, const std::array<std::optional<double>, 2>& forces_n, double bottom) {
  constexpr double kColumn = kGaugeWidth + 6, kLine = 28;
  const auto fingers =
      static_cast<double>(std::ranges::count_if(forces_n, [](const auto& n) { return n.has_value(); }));
  if (fingers == 0) return;
  const double height = kGaugeHeight + 34 + fingers * kLine, top = std::min(kGaugeTop, bottom + 14 - height);
  double x = script.width() - kMargin - kGaugeWidth - (fingers - 1) * kColumn;
  double y = top + kGaugeHeight + 12;
  const double right = script.width() - kMargin;
  script.box({x - 56, top - 14, right - x + 70, height}, kBlack, 0.5);
  for (const int newtons : {0, 5, 10}) {
    script.text(std::to_string(newtons), 6, x - 10, top + kGaugeHeight * (1 - newtons / kGaugeNewtons), 20, kGray);
  }
  for (std::size_t i = 0; i < forces_n.size(); ++i) {
    if (!forces_n[i]) continue;
    const double level = kGaugeHeight * std::clamp(*forces_n[i] / kGaugeNewtons, 0.0, 1.0);
    script.box({x, top, kGaugeWidth, kGaugeHeight}, kWhite, 0.25);
    script.box({x, top + kGaugeHeight - level, kGaugeWidth, level}, kFingerColors[i], 1);
    script.text(print("%.1f N", *forces_n[i]), 9, right + 4, y, 26, fingers > 1 ? kFingerColors[i] : kWhite);
    x += kColumn;
    y += kLine;
  }
}

// An arrowhead at the edge that is nearest to the finger, pointing to it.
void addFinger(Script& script, std::size_t which, const FingerBeside& finger) {
  const double x = std::clamp(script.width() * (0.5 + finger.across), kEdge, script.width() - kEdge);
  const double y = std::clamp(script.rows() * (0.5 - finger.up), kEdge, script.rows() - kEdge);
  const double to_x = script.width() * (0.5 + finger.across) - x, to_y = script.rows() * (0.5 - finger.up) - y;
  const double length = std::max(std::hypot(to_x, to_y), 1e-3);
  const double along_x = 24 * to_x / length, along_y = 24 * to_y / length;
  script.shape({{30 + along_x, 30 + along_y},
                {30 - along_x - along_y, 30 - along_y + along_x},
                {30 - along_x + along_y, 30 - along_y - along_x}},
               x - 30, y - 30, kFingerColors[which], 0.9);
}

// Returns where the next part begins; likewise below.
double addNotice(Script& script, const ScreenNotice& notice) {
  constexpr double kSize = 36, kLine = 44;
  double y = kTop;
  for (const std::string& line : folded(notice.words, cellsIn(script.width() - 2 * kMargin, kSize), 2)) {
    script.text(line, 7, kMargin, y, kSize);
    y += kLine;
  }
  if (notice.level) {
    script.box({kMargin, y + 6, 300, 10}, kWhite, 0.3);
    script.box({kMargin, y + 6, 300 * std::clamp(*notice.level, 0.0, 1.0), 10}, kAccent, 1);
    y += 16;
  }
  return y + kGap;
}

// In the heading's line of a page that covers the film, between the heading and the text at its right end.
void addNoticeInHeading(Script& script, const ScreenNotice& notice) {
  constexpr double kSize = 28, kSides = 170, kLevel = 240;
  const double middle = 0.5 * script.width();
  const auto line = folded(notice.words, cellsIn(script.width() - 2 * kSides, kSize), 1);
  if (!line.empty()) script.text(line[0], 8, middle, kHeadingTop, kSize);
  if (!notice.level) return;
  script.box({middle - kLevel / 2, 62, kLevel, 8}, kWhite, 0.3);
  script.box({middle - kLevel / 2, 62, kLevel * std::clamp(*notice.level, 0.0, 1.0), 8}, kAccent, 1);
}

double addWarning(Script& script, const std::string& why, double top, double opacity) {
  constexpr double kSize = 26, kLine = 34;
  const auto lines = folded(why, cellsIn(script.width() - 2 * kMargin, kSize), 3);
  const double height = kLine * static_cast<double>(lines.size()) + 10;
  script.box({kMargin - 14, top, script.width() - 2 * kMargin + 28, height}, kBlack, opacity);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    script.text(lines[i], 7, kMargin, top + 4 + kLine * static_cast<double>(i), kSize, kWarn);
  }
  return top + height + kGap;
}

// Near the top of the picture, where subtitles above the bar do not reach the hint. Returns the end of it.
double addHint(Script& script, const std::string& hint, double top) {
  constexpr double kSize = 32, kLine = 40;
  double y = std::max(top, 100.0);
  for (const std::string& line : folded(hint, cellsIn(script.width() - 2 * kMargin, kSize), 2)) {
    script.text(line, 8, 0.5 * script.width(), y, kSize);
    y += kLine;
  }
  return y + kGap;
}

// As many lines as fit above `bottom`.
void addStatistics(Script& script, const ScreenRows& rows, double top, double bottom) {
  constexpr double kUsual = 160, kLine = 28, kSize = 22, kLabel = 110, kBesideForce = 90;
  const double y_begin = std::max(kUsual, top);
  const double width = std::min(820.0, script.width() - 2 * kMargin - kBesideForce);
  ScreenRows lines;
  for (const auto& [label, figures] : rows) {
    std::string first = label;
    for (const std::string& line : folded(figures, cellsIn(width - kLabel, kSize), 3)) {
      lines.emplace_back(std::exchange(first, ""), line);
    }
  }
  const double most = std::max(0.0, std::floor((bottom - y_begin - 20) / kLine));
  lines.resize(std::min(lines.size(), static_cast<std::size_t>(most)));
  script.box({kMargin - 14, y_begin, width + 28, kLine * static_cast<double>(lines.size()) + 20}, kBlack, 0.6);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double y = y_begin + 10 + kLine * static_cast<double>(i);
    script.text(lines[i].first, 7, kMargin, y, kSize, kAccent);
    script.text(lines[i].second, 7, kMargin + kLabel, y, kSize);
  }
}

// The texts over a film, from the top down.
void addTop(Script& script, const ScreenContent& content, double bottom) {
  double top = kTop;
  if (content.notice) top = addNotice(script, *content.notice);
  if (!content.warning.empty()) top = addWarning(script, content.warning, std::max(top, 100.0), 0.6);
  if (!content.hint.empty()) top = addHint(script, content.hint, top);
  if (!content.statistics.empty()) addStatistics(script, content.statistics, top, bottom);
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

std::vector<std::string> screenLines(const ScreenContent& content, double aspect, int view_height) {
  Script page(kScreenRows * aspect);
  if (content.list) {
    addList(page, *content.list, {.help = content.help_key, .choose = content.choose_key});
    return page.take();
  }
  if (!content.keys.empty()) {
    addKeys(page, {content.keys, content.keys_page, content.help_key, view_height});
    if (content.notice) addNoticeInHeading(page, *content.notice);
    return page.take();
  }
  Script script(filmRows(aspect) * aspect, filmRows(aspect));
  for (std::size_t i = 0; i < content.fingers.size(); ++i) {
    if (content.fingers[i]) addFinger(script, i, *content.fingers[i]);
  }
  if (content.bar) addBar(script, *content.bar);
  const double room = script.rows() * roomForWords(content, aspect);
  addForces(script, content.forces_n, room);
  addTop(script, content, room);
  return script.take();
}

std::vector<std::string> linesOverPosters(const ScreenContent& content, double aspect) {
  constexpr double kWarningTop = ScreenList::kBottomOverWarning + 2;
  Script script(kScreenRows * aspect);
  if (!content.list) return {};
  if (!content.warning.empty()) addWarning(script, content.warning, kWarningTop, 1);
  if (content.notice) addNoticeInHeading(script, *content.notice);
  return script.take();
}

}  // namespace relievo
