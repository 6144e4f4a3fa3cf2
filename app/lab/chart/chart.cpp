// SPDX-License-Identifier: Apache-2.0
// gnuplot names every drawing after itself; the chart's own words take that place.
#include "app/lab/chart/chart.h"

#include <algorithm>
#include <charconv>
#include <span>
#include <sstream>
#include <system_error>
#include <vector>

#include "app/lab/chart/gnuplot.h"
#include "platform/atomic_file.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::size_t kColumns = 125;  // of a reading under a chart
constexpr std::size_t kRoomLines = 2;  // which the scripts draw
constexpr int kLinePixels = 20, kFirstBelow = 15;

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

// Adds `pixels` to the number after PREFIX in the SVG.
void enlarge(std::string& svg, std::string_view prefix, int pixels) {
  const std::size_t at = svg.find(prefix);
  if (at == std::string::npos) return;
  const std::size_t begin = svg.find_first_not_of(' ', at + prefix.size());
  std::size_t end = begin;
  int number = 0;
  for (; end < svg.size() && svg[end] >= '0' && svg[end] <= '9'; ++end) number = 10 * number + (svg[end] - '0');
  svg.replace(begin, end - begin, std::to_string(number + pixels));
}

// Lines in the middle below the picture, which is made so much higher, its background as well.
void writeBelow(std::string& svg, std::span<const std::string> lines) {
  constexpr std::string_view kBox = "viewBox=\"0 0 ";
  int width = 0, height = 0;
  const std::size_t box = svg.find(kBox), end = svg.rfind("</svg>");
  if (lines.empty() || box == std::string::npos || end == std::string::npos) return;
  const char* const svg_end = svg.data() + svg.size();
  const auto first = std::from_chars(svg.data() + box + kBox.size(), svg_end, width);
  if (first.ec != std::errc{} || std::from_chars(first.ptr + 1, svg_end, height).ec != std::errc{}) return;
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += print(
                "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\" font-family=\"sans-serif\" font-size=\"13\" "
                "fill=\"black\">",
                width / 2, height + kFirstBelow + kLinePixels * static_cast<int>(i)) +
            escaped(lines[i]) + "</text>\n";
  }
  svg.insert(end, text);
  const int more = kFirstBelow + kLinePixels * static_cast<int>(lines.size());
  enlarge(svg, print("<rect x=\"0\" y=\"0\" width=\"%d\" height=\"", width), more);
  enlarge(svg, std::string(kBox) + std::to_string(width), more);
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
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
  const std::vector<std::string> lines = linesOf(wrapped(words.reading));
  const std::size_t first = std::min(lines.size(), kRoomLines);
  std::string reading;
  for (std::size_t i = 0; i < first; ++i) reading += (i > 0 ? "\n" : "") + lines[i];
  auto svg = runGnuplot(chartScript(name), {folder + "/" + name + ".csv", words.title, reading});
  if (!svg) return std::unexpected(svg.error());
  writeBelow(*svg, std::span(lines).subspan(first));
  replace(*svg, "title", words.title);
  replace(*svg, "desc", words.reading);
  constexpr std::string_view kDescribed = "</desc>";
  if (const std::size_t end = svg->find(kDescribed); end != std::string::npos)
    svg->insert(end + kDescribed.size(), "\n<metadata>" + escaped(words.occasion) + "</metadata>");
  const std::string path = folder + "/" + name + ".svg";
  auto file = AtomicFile::create(path);
  if (!file) return failOn(path, file.error());
  file->write(*svg);
  if (const auto done = file->commit(); !done) return failOn(path, done.error());
  return {};
}

std::vector<std::string> drawnLines(const ChartWords& words) {
  std::vector<std::string> lines = linesOf(wrapped(words.reading));
  lines.insert(lines.begin(), words.title);
  return lines;
}

std::optional<ChartWords> wordsOf(std::string_view svg) {
  const auto title = find(svg, "title"), reading = find(svg, "desc"), occasion = find(svg, "metadata");
  if (!title || !reading) return std::nullopt;
  const auto text = [&](const Element& e) { return unescaped(svg.substr(e.begin, e.end - e.begin)); };
  return ChartWords{text(*title), text(*reading), occasion ? text(*occasion) : ""};
}

}  // namespace relievo
