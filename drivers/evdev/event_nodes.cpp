// SPDX-License-Identifier: Apache-2.0
// Reads the folder of the input devices.
#include "drivers/evdev/event_nodes.h"

#include <linux/input.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <string_view>
#include <system_error>

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

bool mayHave(const std::string& path, const char* kind, unsigned code) {
  const std::string name = std::filesystem::path(path).filename();
  std::ifstream file("/sys/class/input/" + name + "/device/capabilities/" + kind);
  std::string words;
  return !std::getline(file, words) || listsKey(words, code);
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

bool takeNode(int fd) noexcept {
  if (::flock(fd, LOCK_EX | LOCK_NB) < 0 && errno == EWOULDBLOCK) return false;  // without locks it is shared
  if (::ioctl(fd, EVIOCGRAB, 1) < 0) return errno != EBUSY;
  static_cast<void>(::ioctl(fd, EVIOCGRAB, nullptr));  // it was only a question
  return true;
}

bool mayHaveKey(const std::string& path, unsigned code) {
  return mayHave(path, "key", code);
}

bool mayHaveMotion(const std::string& path, unsigned code) {
  return mayHave(path, "rel", code);
}

bool listsKey(std::string_view words, unsigned code) noexcept {
  constexpr unsigned kBits = 8 * sizeof(long);  // of the kernel's words
  for (unsigned left = code / kBits; left > 0; --left) {
    const std::size_t space = words.rfind(' ');
    if (space == std::string_view::npos) return false;
    words.remove_suffix(words.size() - space);
  }
  if (const std::size_t space = words.rfind(' '); space != std::string_view::npos) words.remove_prefix(space + 1);
  unsigned long bits = 0;
  if (std::from_chars(words.data(), words.data() + words.size(), bits, 16).ec != std::errc()) return false;
  return (bits >> code % kBits & 1U) != 0;
}

}  // namespace relievo
