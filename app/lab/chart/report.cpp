// SPDX-License-Identifier: Apache-2.0
// The charts lie in the page itself, in its colours: the page can be moved about alone, and read by day and by night.
#include "app/lab/chart/report.h"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <optional>

#include "app/lab/chart/chart.h"
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
       max-width: 68rem; padding: 1.5rem; }
h1 { font-size: 1.6rem; margin: 0; }
h2 { font-size: 1.2rem; margin: 0 0 .3rem; }
a { color: var(--link); }
.about { color: var(--faint); margin: .2rem 0 2rem; }
section { border-top: 1px solid var(--line); margin: 2rem 0 0; padding: 1.5rem 0 0; }
section p { margin: 0 0 .6rem; }
svg { display: block; height: auto; width: 100%; }
svg > g > rect[fill="#ffffff"] { fill: var(--paper); }
svg [color="#FFFFFF"] { color: var(--paper); }
svg [color="black"], svg [color="rgb(  0,   0,   0)"] { color: var(--ink); }
svg [stroke="black"], svg [stroke="rgb(  0,   0,   0)"] { stroke: var(--ink); }
svg [fill="black"], svg [fill="rgb(0,0,0)"] { fill: var(--ink); }
svg [stroke="rgb(216, 219, 224)"] { stroke: var(--line); }
</style>
)html";

std::optional<std::string> readText(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

std::string processorName() {
  std::ifstream cpus("/proc/cpuinfo");
  for (std::string line; std::getline(cpus, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "processor unknown";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm date{};
  ::gmtime_r(&now, &date);
  return print("%04d-%02d-%02d", date.tm_year + 1900, date.tm_mon + 1, date.tm_mday);
}

std::string sectionOf(const std::string& folder, const std::string& chart) {
  const auto svg = readText(folder + "/" + chart + ".svg");
  const std::string csv = "<a href=\"" + chart + ".csv\">" + chart + ".csv</a>";
  if (!svg)
    return "<section id=\"" + chart + "\">\n<h2>" + chart + "</h2>\n<p>Not drawn. " + csv + "</p>\n</section>\n";
  const ChartWords words = wordsOf(*svg).value_or(ChartWords{chart, ""});
  const std::size_t begin = std::min(svg->find("<svg"), svg->size());  // behind the XML declaration
  return "<section id=\"" + chart + "\">\n<h2>" + escaped(words.title) + "</h2>\n<p>" + escaped(words.reading) + " " +
         csv + "</p>\n" + svg->substr(begin) + "</section>\n";
}

bool isComplete(const Measurement& measurement, const std::string& folder) {
  return std::all_of(measurement.charts.begin(), measurement.charts.end(), [&](const char* chart) {
    return std::ifstream(folder + "/" + chart + ".svg").good() && std::ifstream(folder + "/" + chart + ".csv").good();
  });
}

}  // namespace

Outcome<void> writeReport(const MeasureOptions& options) {
  Outcome<void> first_failure;
  std::string page = kHead;
  page += "<h1>relievo: measurements of touch</h1>\n<p class=\"about\">" + escaped(processorName()) + ", " + today() +
          (options.quick ? ", quick run" : "") + "</p>\n";
  const auto all = measurements();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Measurement& measurement = all[i];
    if (!isComplete(measurement, options.out)) {
      MeasureOptions part = options;
      part.tell = [&, i](const std::string& what) {
        options.tell(print("part %zu of %zu: ", i + 1, all.size()) + what);
      };
      const auto done = runMeasurement(measurement, part);
      if (!done && first_failure) first_failure = done;
    }
    for (const char* chart : measurement.charts) page += sectionOf(options.out, chart);
  }
  page += "</html>\n";

  const std::string path = options.out + "/index.html";
  auto file = AtomicFile::create(path);
  if (!file) return failOn(path, file.error());
  file->write(page);
  if (const auto written = file->commit(); !written) return failOn(path, written.error());
  return first_failure;
}

}  // namespace relievo
