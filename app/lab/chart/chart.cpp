// SPDX-License-Identifier: Apache-2.0
// gnuplot names every drawing after itself; the chart's own words take that place.
#include "app/lab/chart/chart.h"

#include <algorithm>

#include "app/lab/chart/gnuplot.h"
#include "platform/atomic_file.h"

namespace relievo {
namespace {

constexpr std::size_t kColumns = 125;     // of a reading under a chart
constexpr std::ptrdiff_t kRoomLines = 2;  // for which the scripts leave room
constexpr int kLinePixels = 20;

struct Element {
  std::size_t begin = 0, end = 0;  // of what is between the tags
};

std::optional<Element> find(std::string_view svg, std::string_view name) {
  const std::string open = "<" + std::string(name) + ">", close = "</" + std::string(name) + ">";
  const std::size_t begin = svg.find(open);
  if (begin == std::string_view::npos) return std::nullopt;
  const std::size_t end = svg.find(close, begin);
  if (end == std::string_view::npos) return std::nullopt;
  return Element{begin + open.size(), end};
}

void replace(std::string& svg, std::string_view name, std::string_view text) {
  if (const auto e = find(svg, name)) svg.replace(e->begin, e->end - e->begin, escaped(text));
}

constexpr std::pair<char, std::string_view> kEntities[] = {
    {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};

std::string unescaped(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto* const entity = std::find_if(std::begin(kEntities), std::end(kEntities),
                                            [&](const auto& e) { return text.substr(i).starts_with(e.second); });
    plain += entity != std::end(kEntities) ? entity->first : text[i];
    if (entity != std::end(kEntities)) i += entity->second.size() - 1;
  }
  return plain;
}

// Between words, but not between a number and its unit.
std::string wrapped(std::string text) {
  for (std::size_t line = 0; text.size() - line > kColumns;) {
    std::size_t space = text.rfind(' ', line + kColumns);
    while (space != std::string::npos && space > line && text[space - 1] >= '0' && text[space - 1] <= '9') {
      space = text.rfind(' ', space - 1);
    }
    if (space == std::string::npos || space <= line) break;
    text[space] = '\n';
    line = space + 1;
  }
  return text;
}

// What stands in the SVG as PREFIX and a number becomes so much more.
void enlarge(std::string& svg, std::string_view prefix, int pixels) {
  const std::size_t at = svg.find(prefix);
  if (at == std::string::npos) return;
  const std::size_t begin = svg.find_first_not_of(' ', at + prefix.size());
  std::size_t end = begin;
  int number = 0;
  for (; end < svg.size() && svg[end] >= '0' && svg[end] <= '9'; ++end) number = 10 * number + (svg[end] - '0');
  svg.replace(begin, end - begin, std::to_string(number + pixels));
}

// The picture's and its background's height: the lines of a long reading go on below.
void makeRoom(std::string& svg, int pixels) {
  const std::size_t box = svg.find("viewBox=\"0 0 ");
  if (box == std::string::npos) return;
  const std::size_t width = box + std::string_view("viewBox=\"0 0 ").size();
  const std::string columns = svg.substr(width, svg.find(' ', width) - width);
  enlarge(svg, "viewBox=\"0 0 " + columns, pixels);
  enlarge(svg, "<rect x=\"0\" y=\"0\" width=\"" + columns + "\" height=\"", pixels);
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const auto* const entity =
        std::find_if(std::begin(kEntities), std::end(kEntities), [&](const auto& e) { return e.first == c; });
    if (entity != std::end(kEntities)) {
      safe += entity->second;
    } else {
      safe += c;
    }
  }
  return safe;
}

Outcome<void> drawChart(const std::string& folder, const std::string& name, const ChartWords& words) {
  const std::string reading = wrapped(words.reading);
  const auto lines = std::max(std::count(reading.begin(), reading.end(), '\n') + 1, kRoomLines);
  auto svg = runGnuplot(chartScript(name), {folder + "/" + name + ".csv", words.title, reading, std::to_string(lines)});
  if (!svg) return std::unexpected(svg.error());
  makeRoom(*svg, kLinePixels * static_cast<int>(lines - kRoomLines));
  replace(*svg, "title", words.title);
  replace(*svg, "desc", words.reading);
  const std::string path = folder + "/" + name + ".svg";
  auto file = AtomicFile::create(path);
  if (!file) return failOn(path, file.error());
  file->write(*svg);
  if (const auto done = file->commit(); !done) return failOn(path, done.error());
  return {};
}

std::optional<ChartWords> wordsOf(std::string_view svg) {
  const auto title = find(svg, "title"), reading = find(svg, "desc");
  if (!title || !reading) return std::nullopt;
  const auto text = [&](const Element& e) { return unescaped(svg.substr(e.begin, e.end - e.begin)); };
  return ChartWords{text(*title), text(*reading)};
}

}  // namespace relievo
