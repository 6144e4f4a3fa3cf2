// SPDX-License-Identifier: Apache-2.0
// A command that runs beside the program, with pipes to what it reads and from what it writes.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "platform/error.h"
#include "platform/unique_fd.h"

namespace relievo {

// Runs `/bin/sh -c` in a process group of its own. This side's ends of the pipes do not block. The destructor ends the
// whole group: SIGTERM, a second to tidy up, SIGKILL. If this program is killed, the group is killed too. Processes
// that leave the group (setsid) are not ended.
class ChildProcess {
 public:
  // `variables`: NAME=VALUE, besides this program's own.
  [[nodiscard]] static Result<ChildProcess> start(const std::string& command,
                                                  const std::vector<std::string>& variables);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();

  UniqueFd input, output, messages;  // its standard input, output and error

  struct End {
    bool by_signal = false;
    int number = 0;  // exit code or signal
  };
  // Nullopt while it runs.
  [[nodiscard]] std::optional<End> end() const noexcept;

 private:
  ChildProcess() = default;
  UniqueFd life_;  // closed by the kernel at the latest when this program ends
  pid_t pid_ = -1;
};

}  // namespace relievo
