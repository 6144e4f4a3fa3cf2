// SPDX-License-Identifier: Apache-2.0
// Lists mounted USB sticks and other removable media, and notices changes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/unique_fd.h"

namespace relievo {

// The folders where desktops and boxes mount removable media.
[[nodiscard]] std::vector<std::string> stickRoots();

// The mount points at or below `roots` in the text of /proc/PID/mountinfo (proc(5)), each once, sorted.
[[nodiscard]] std::vector<std::string> sticksIn(std::string_view mountinfo, const std::vector<std::string>& roots);

// Follows this process's mounts. One thread; never waits: the kernel keeps the table in memory.
class StickWatch {
 public:
  explicit StickWatch(std::vector<std::string> roots);

  // True when the sticks have changed since the last call; at the first call, if there are any.
  [[nodiscard]] bool changed();
  [[nodiscard]] const std::vector<std::string>& sticks() const noexcept { return sticks_; }

 private:
  const std::vector<std::string> roots_;
  UniqueFd mounts_;
  std::vector<std::string> sticks_;
  bool first_ = true;
};

}  // namespace relievo
