// SPDX-License-Identifier: Apache-2.0
// Any text as a list of pictures, and its lines as the names of pictures in two folders and as a pattern: times are in
// order, none is negative, and every picture is there once.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/pictures/folder.h"
#include "drivers/pictures/lists.h"
#include "drivers/pictures/names.h"
#include "drivers/pictures/recording.h"

namespace relievo::pictures {
namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

void checkSeries(const std::vector<TimedPicture>& pictures, std::size_t names) {
  require(pictures.size() <= names, "no picture comes twice");
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    require(pictures[i].time >= Duration(0), "times from 0 on");
    require(i == 0 || pictures[i].time >= pictures[i - 1].time, "times in order");
  }
}

void checkRecording(const FoundPictures& found, std::optional<double> rate) {
  const Recording recording = recordingOf(found, rate);
  checkSeries(recording.color, found.color.names.size());
  checkSeries(recording.depth, found.depth.names.size());
  require(recording.period >= Duration(0), "a period");
  const auto& leading = recording.color.empty() ? recording.depth : recording.color;
  require(leading.back().time <= Duration::max() - recording.period, "an end");
}

void checkSeconds(std::string_view text) {
  const auto ns = nanosecondsIn(text);
  if (!ns) return;
  const double seconds = std::strtod(std::string(text).c_str(), nullptr);
  require(std::abs(static_cast<double>(*ns) * 1e-9 - seconds) <= 1e-9 + 1e-15 * seconds, "the time that is written");
}

void checkList(std::string_view text) {
  if (const auto list = parsePictureList(text, 1)) {
    FoundPictures found{.listed_numbers = list->numbers};
    std::set<std::int64_t> seen;
    for (const auto& line : list->lines) {
      if (!seen.insert(line[0].value).second) continue;
      found.color.names.push_back(line[0].name);
      found.color_values.push_back(line[0].value);
    }
    checkRecording(found, std::nullopt);
  }
  static_cast<void>(parsePictureList(text, 2));
}

// Names as a folder has them: all different, without slashes.
std::vector<std::string> namesOf(const std::vector<std::string_view>& lines, std::size_t begin, std::size_t step) {
  std::vector<std::string> names;
  for (std::size_t i = begin; i < lines.size(); i += step) {
    std::string name(lines[i]);
    std::ranges::replace(name, '/', '_');
    name += ".png";
    if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  }
  return names;
}

void checkNames(const std::vector<std::string>& names) {
  const NameValues values = valuesOf(names);
  require(values.values.size() == names.size(), "a value for each name");
  require(std::set(values.values.begin(), values.values.end()).size() == names.size(), "all of them different");
}

void fuzz(std::string_view text) {
  checkList(text);
  std::vector<std::string_view> lines;
  for (std::size_t at = 0; at < text.size() && lines.size() < 64;) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    checkSeconds(lines.back());
    at = end + 1;
  }
  if (lines.empty()) return;
  const std::vector<std::string> all = namesOf(lines, 0, 1), odd = namesOf(lines, 1, 2);
  checkNames(all);
  checkRecording({.color = {"a/", all}}, std::nullopt);
  checkRecording({.depth = {"b/", all}}, 0.01);
  if (!odd.empty()) checkRecording({.color = {"a/", namesOf(lines, 0, 2)}, .depth = {"b/", odd}}, std::nullopt);
  const std::string pattern = all.front();
  if (pattern.find('\0') == pattern.npos) static_cast<void>(findPictures("/proc/self/fdinfo/" + pattern));
}

}  // namespace
}  // namespace relievo::pictures

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::pictures::fuzz({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
