// SPDX-License-Identifier: Apache-2.0
// The charts are SVG inside the page and use its colours: the page is one file, readable in light and in dark mode.
#include "app/lab/chart/report.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

#include "app/lab/chart/chart.h"
#include "app/lab/chart/occasion.h"
#include "platform/atomic_file.h"
#include "platform/print.h"

namespace relievo {
namespace {

// gnuplot writes black on white as attributes, which a style sheet may overrule.
constexpr const char* kHead = R"html(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>relievo: measurements of touch</title>
<style>
:root { color-scheme: light dark; --paper: #fff; --ink: #1c2024; --faint: #667; --line: #d8dbe0; --link: #1a5fb4; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #15181c; --ink: #e6e8eb; --faint: #9aa1ab; --line: #3a4048; --link: #8ab8ff; }
}
body { background: var(--paper); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; margin: 0 auto;
       max-width: 68rem; padding: 1rem; }
h1 { font-size: 1.6rem; margin: 0 0 2rem; }
h2 { font-size: 1.2rem; margin: 0 0 .3rem; }
a { color: var(--link); }
.occasion { color: var(--faint); }
section { border-top: 1px solid var(--line); margin: 2rem 0 0; padding: 1.5rem 0 0; }
section p { margin: 0 0 .6rem; }
dt { font-weight: 600; }
dd { margin: 0 0 .4rem; }
.chart { overflow-x: auto; }
svg { display: block; height: auto; min-width: 48rem; width: 100%; }
@media print {
  :root { color-scheme: light; --paper: #fff; --ink: #000; --faint: #444; --line: #ccc; --link: #000; }
  body { max-width: none; padding: 0; }
  section { break-inside: avoid; }
  svg { min-width: 0; }
}
svg > g > rect[fill="#ffffff"] { fill: var(--paper); }
svg [color="#FFFFFF"] { color: var(--paper); }
svg [color="black"], svg [color="rgb(  0,   0,   0)"] { color: var(--ink); }
svg [stroke="black"], svg [stroke="rgb(  0,   0,   0)"] { stroke: var(--ink); }
svg [fill="black"], svg [fill="rgb(0,0,0)"] { fill: var(--ink); }
svg [stroke="rgb(216, 219, 224)"] { stroke: var(--line); }
</style>
)html";

constexpr const char* kWords = R"html(<h2 id="words">Words</h2>
<dl>
<dt>16-bit, 8-bit, H.264 crf 23, noise 1 %</dt>
<dd>How the depth of the same scene is stored: exact to 1/65535 or 1/255 of its range, compressed, or with a camera's noise.</dd>
<dt>force error</dt>
<dd>The difference between a method's force and the force of the exact surface (the oracle), in percent of that force.</dd>
<dt>god-object, proxy</dt>
<dd>The point on the surface that stands for a finger inside it. The force pulls the finger towards that point.</dd>
<dt>median, p99.9</dt>
<dd>Half of the ticks are faster than the median; one tick in a thousand is slower than p99.9.</dd>
<dt>rms</dt>
<dd>Root of the mean square: large errors count more than small ones.</dd>
<dt>tick</dt>
<dd>One round of the haptic task, a millisecond: read the finger, compute the force, write the force. The time to force ends
there; the upkeep prepares the next tick.</dd>
<dt>whole tick</dt>
<dd>Time to force and upkeep together, with a method's work per frame spread over the frame's ticks.</dd>
</dl>
)html";

std::optional<std::string> readText(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

// A drawing holds its title and reading for those who see it alone; the page prints them as text.
std::string withoutWords(std::string svg, const ChartWords& words) {
  const std::size_t drawing = svg.find("</desc>");
  for (const std::string& line : drawnLines(words)) {
    const std::string text = ">" + escaped(line) + "<";
    const std::size_t at = svg.find(text, std::min(drawing, svg.size()));
    if (at != std::string::npos) svg.erase(at + 1, text.size() - 2);
  }
  return svg;
}

std::string sectionOf(const std::string& folder, const std::string& chart) {
  const auto svg = readText(folder + "/" + chart + ".svg");
  const std::string csv = "<a href=\"" + chart + ".csv\">" + chart + ".csv</a>";
  if (!svg)
    return "<section id=\"" + chart + "\">\n<h2>" + chart + "</h2>\n<p>Not drawn. " + csv + "</p>\n</section>\n";
  const ChartWords words = wordsOf(*svg).value_or(ChartWords{chart, "", ""});
  const std::size_t begin = std::min(svg->find("<svg"), svg->size());  // behind the XML declaration
  return "<section id=\"" + chart + "\">\n<h2>" + escaped(words.title) + "</h2>\n<p>" + escaped(words.reading) + " " +
         csv + "</p>\n<p class=\"occasion\">" + escaped(words.occasion) + "</p>\n<div class=\"chart\">\n" +
         withoutWords(svg->substr(begin), words) + "</div>\n</section>\n";
}

// A link to each section, by its heading.
std::string contentsOf(const std::string& sections) {
  constexpr std::string_view kSection = "<section id=\"", kHeading = "<h2>";
  std::string list = "<h2>Contents</h2>\n<ul>\n<li><a href=\"#words\">Words</a></li>\n";
  for (std::size_t at = 0; (at = sections.find(kSection, at)) != std::string::npos;) {
    at += kSection.size();
    const std::size_t heading = sections.find(kHeading, at) + kHeading.size();
    list += "<li><a href=\"#" + sections.substr(at, sections.find('"', at) - at) + "\">" +
            sections.substr(heading, sections.find("</h2>", heading) - heading) + "</a></li>\n";
  }
  return list + "</ul>\n";
}

bool isComplete(const Measurement& measurement, const MeasureOptions& options) {
  return std::all_of(measurement.charts.begin(), measurement.charts.end(), [&](const ChartEntry& chart) {
    const std::string path = options.out + "/" + chart.name;
    const auto words = wordsOf(readText(path + ".svg").value_or(""));
    return words && !words->occasion.empty() && isOfQuickRun(words->occasion) == options.quick &&
           std::ifstream(path + ".csv").good();
  });
}

}  // namespace

Outcome<void> writeReport(const MeasureOptions& options) {
  Outcome<void> first_failure;
  std::string page = kHead;
  page += "<h1>relievo: measurements of touch</h1>\n";
  std::string sections;
  const auto all = measurements();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Measurement& measurement = all[i];
    if (!isComplete(measurement, options)) {
      MeasureOptions part = options;
      part.tell = [&, i](const std::string& what) {
        options.tell(print("part %zu of %zu: ", i + 1, all.size()) + what);
      };
      const auto done = runMeasurement(measurement, part);
      if (!done && done.error().thing.starts_with(options.out + "/")) return done;  // the others would fail there too
      if (!done && first_failure) first_failure = done;
    }
    for (const ChartEntry& chart : measurement.charts) sections += sectionOf(options.out, chart.name);
  }
  page += contentsOf(sections) + kWords + sections + "</html>\n";

  const std::string path = options.out + "/index.html";
  auto file = AtomicFile::create(path);
  if (!file) return failOn(path, file.error());
  file->write(page);
  if (const auto written = file->commit(); !written) return failOn(path, written.error());
  return first_failure;
}

}  // namespace relievo
