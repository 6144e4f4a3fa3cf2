// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/odometry.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/pictures/names.h"
#include "platform/whole_file.h"

namespace relievo::pictures {
namespace {

constexpr std::string_view kFolder = "depth/";

std::string_view nextCell(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t end = std::min(line.find(','), line.size());
  std::string_view cell = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  cell.remove_prefix(std::min(cell.find_first_not_of(kBlanks), cell.size()));
  return cell.substr(0, cell.find_last_not_of(kBlanks) + 1);
}

std::optional<std::int64_t> numberOf(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

// The time of each frame, ns.
std::map<std::int64_t, std::int64_t> timesIn(std::string_view text) {
  std::map<std::int64_t, std::int64_t> times;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const auto time = nanosecondsIn(nextCell(line));
    const auto frame = numberOf(nextCell(line));
    if (time && frame) times.emplace(*frame, *time);
  }
  return times;
}

}  // namespace

void takeOdometryTimes(FoundPictures& found) {
  const std::string& folder = found.color.folder;
  if (!folder.ends_with(kFolder)) return;
  const std::string place = folder.substr(0, folder.size() - kFolder.size());
  const auto text = readWholeFile(place + "odometry.csv", FileSize::Recording, "");
  if (!text) return;
  const auto times = timesIn(*text);
  std::vector<std::int64_t> values;
  for (const std::string& name : found.color.names) {
    const auto frame = numberOf(std::string_view(name).substr(0, name.rfind('.')));
    const auto time = frame ? times.find(*frame) : times.end();
    if (time == times.end()) return;
    values.push_back(time->second);
  }
  found.color_values = std::move(values);
}

}  // namespace relievo::pictures
