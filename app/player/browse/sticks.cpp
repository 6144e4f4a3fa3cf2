// SPDX-License-Identifier: Apache-2.0
// The kernel marks /proc/self/mountinfo as readable with priority when a mount is added or removed.
#include "app/player/browse/sticks.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace relievo {
namespace {

constexpr std::size_t kMostText = 1 << 20;  // of the mount table

// The fifth field.
std::optional<std::string_view> mountPointOf(std::string_view line) {
  for (int field = 1; field < 5; ++field) {
    const std::size_t space = line.find(' ');
    if (space == std::string_view::npos) return std::nullopt;
    line.remove_prefix(space + 1);
  }
  return line.substr(0, line.find(' '));
}

bool isOctal(std::string_view digits) noexcept {
  return digits.size() == 3 && std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '7'; });
}

// A space in a name is written \040.
std::string unescaped(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view digits = text.substr(i + 1).substr(0, 3);
    if (text[i] != '\\' || !isOctal(digits)) {
      plain += text[i];
      continue;
    }
    plain += static_cast<char>((digits[0] - '0') * 64 + (digits[1] - '0') * 8 + (digits[2] - '0'));
    i += 3;
  }
  return plain;
}

bool isAtOrBelow(const std::string& path, const std::string& root) noexcept {
  return path == root || (path.starts_with(root) && path[root.size()] == '/');
}

std::string readAll(int fd) {
  std::string text;
  std::array<char, 4096> part{};
  ::lseek(fd, 0, SEEK_SET);
  while (text.size() < kMostText) {
    const ssize_t got = ::read(fd, part.data(), part.size());
    if (got <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(got));
  }
  return text;
}

}  // namespace

std::vector<std::string> stickRoots() {
  return {"/media", "/run/media", "/mnt"};
}

std::vector<std::string> sticksIn(std::string_view mountinfo, const std::vector<std::string>& roots) {
  std::vector<std::string> sticks;
  while (!mountinfo.empty()) {
    const std::size_t end = std::min(mountinfo.find('\n'), mountinfo.size());
    const auto point = mountPointOf(mountinfo.substr(0, end));
    mountinfo.remove_prefix(std::min(end + 1, mountinfo.size()));
    if (!point) continue;
    const std::string path = unescaped(*point);
    if (std::ranges::any_of(roots, [&](const std::string& root) { return isAtOrBelow(path, root); })) {
      sticks.push_back(path);
    }
  }
  std::ranges::sort(sticks);
  const auto again = std::ranges::unique(sticks);
  sticks.erase(again.begin(), again.end());
  return sticks;
}

StickWatch::StickWatch(std::vector<std::string> roots)
    : roots_(std::move(roots)), mounts_(::open("/proc/self/mountinfo", O_RDONLY | O_CLOEXEC)) {}

bool StickWatch::changed() {
  if (!mounts_.valid()) return false;
  pollfd waiting{.fd = mounts_.get(), .events = POLLPRI, .revents = 0};
  const bool told = ::poll(&waiting, 1, 0) > 0;
  if (!std::exchange(first_, false) && !told) return false;
  auto sticks = sticksIn(readAll(mounts_.get()), roots_);
  return std::exchange(sticks_, sticks) != sticks;
}

}  // namespace relievo
