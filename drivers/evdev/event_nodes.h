// SPDX-License-Identifier: Apache-2.0
// The nodes of the kernel's input devices, /dev/input/eventN, as they are now.
#pragma once

#include <ctime>
#include <string>
#include <string_view>
#include <vector>

namespace relievo {

struct EventNode {
  std::string path;
  timespec changed{};  // another device of the same number, or other permissions: another time
  bool operator==(const EventNode& other) const noexcept {
    return path == other.path && changed.tv_sec == other.changed.tv_sec && changed.tv_nsec == other.changed.tv_nsec;
  }
};

// In ascending order of their numbers. Opens nothing. Any thread; not real-time.
[[nodiscard]] std::vector<EventNode> listEventNodes();

// Takes an open node for one finger until it is closed. False if another finger, or another relievo, has it, or if
// another program has grabbed it: all of its events go there, such as those of a mouse whose keys it maps.
[[nodiscard]] bool takeNode(int fd) noexcept;

// Whether the node's device may have a key, by what sysfs says of it; true where that cannot be read. Does not open the
// node: to close one again takes the kernel many milliseconds.
[[nodiscard]] bool mayHaveKey(const std::string& path, unsigned code);
// Likewise for a relative axis.
[[nodiscard]] bool mayHaveMotion(const std::string& path, unsigned code);
// Whether a key is among those of sysfs's `capabilities/key`: a bit each, in hexadecimal words, the highest first.
[[nodiscard]] bool listsKey(std::string_view words, unsigned code) noexcept;

}  // namespace relievo
