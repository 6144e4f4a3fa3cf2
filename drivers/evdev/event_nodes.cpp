// SPDX-License-Identifier: Apache-2.0
// Reads the folder of the input devices.
#include "drivers/evdev/event_nodes.h"

#include <sys/stat.h>

#include <charconv>
#include <filesystem>
#include <map>
#include <string_view>

namespace relievo {
namespace {

constexpr const char* kFolder = "/dev/input";

// The N of "eventN"; -1 for another name.
int numberOf(std::string_view name) {
  constexpr std::string_view kBefore = "event";
  if (!name.starts_with(kBefore)) return -1;
  int number = -1;
  const char* const last = name.data() + name.size();
  return std::from_chars(name.data() + kBefore.size(), last, number).ptr == last ? number : -1;
}

}  // namespace

std::vector<EventNode> listEventNodes() {
  std::map<int, EventNode> by_number;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(kFolder, error), end; !error && entry != end; entry.increment(error)) {
    const int number = numberOf(entry->path().filename().string());
    if (number < 0) continue;
    EventNode node{.path = entry->path(), .changed = {}};
    struct stat about{};
    if (::stat(node.path.c_str(), &about) == 0) node.changed = about.st_ctim;
    by_number.emplace(number, std::move(node));
  }
  std::vector<EventNode> nodes;
  nodes.reserve(by_number.size());
  for (auto& [number, node] : by_number) nodes.push_back(std::move(node));
  return nodes;
}

}  // namespace relievo
